# gnuplot larger-box.gp  draws larger-box.png from larger-box.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'larger-box.png'
set multiplot layout 2,2 title "The layers in a larger box" font ',17'

reset
unset title
set title '(a) smaller box'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'larger-box-1.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(b) larger box'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'larger-box-2.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(c) distribution of angles'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'angle to the director {/Symbol q} (rad)'
set ylabel 'P({/Symbol q}) (1/rad)'
set key font ',11' spacing 1.0
set xrange [-0.8:0.8]
set yrange [0:*]
set tmargin 3.5
plot 'larger-box.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'L = 41.87 mm', \
     'larger-box.dat' index 1 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'L = 66.98 mm'

reset
unset title
set title '(d) G_2 across the director'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance across the director (mm)'
set ylabel 'G_2'
set key font ',11' spacing 1.0
set xrange [0:*]
set tmargin 3.5
unset key
plot 'larger-box.dat' index 2 using 1:2 with lines linecolor '#440154' linewidth 1 title 'L = 41.87 mm', \
     'larger-box.dat' index 3 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'L = 66.98 mm'
unset multiplot
