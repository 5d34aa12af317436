# gnuplot fig08-layers.gp  draws fig08-layers.png from fig08-layers.dat
set terminal pngcairo size 2160,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig08-layers.png'
set multiplot layout 2,3 title "The layered phase" font ',17'

reset
unset title
set title '(a) φ = 0.75'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'fig08-layers-1.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(b) φ = 0.8'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'fig08-layers-2.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(c) φ = 0.85'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'fig08-layers-3.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(d) distribution of angles'
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
plot 'fig08-layers.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.75', \
     'fig08-layers.dat' index 1 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.8', \
     'fig08-layers.dat' index 2 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(e) G_2 across the director'
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
plot 'fig08-layers.dat' index 3 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.75', \
     'fig08-layers.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.8', \
     'fig08-layers.dat' index 5 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(f) structure factor of the angles'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'wave number across the director (1/mm)'
set ylabel 'spectrum of sin 2({/Symbol q} − {/Symbol q}_N)'
set key font ',11' spacing 1.0
set xrange [0:2]
set logscale y
set tmargin 3.5
unset key
plot 'fig08-layers.dat' index 6 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.75', \
     'fig08-layers.dat' index 7 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.8', \
     'fig08-layers.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'
unset multiplot
