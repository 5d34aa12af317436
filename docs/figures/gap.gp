# gnuplot gap.gp  draws gap.png from gap.dat
set terminal pngcairo size 2160,1730 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'gap.png'
set multiplot layout 3,3 title "The gap between the plates" font ',17'

reset
unset title
set title '(a) w = 0.9 mm'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'gap-1.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(b) w = 1.2 mm'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'gap-2.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(c) w = 1.4 mm'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'gap-3.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(d) w = 1.6 mm'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'gap-4.png' binary filetype=png with rgbimage notitle

reset
unset title
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel ''
set ylabel ''
set key font ',11' spacing 1.0
unset border
unset tics
unset label
plot [1:2][1:2] NaN notitle

reset
unset title
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel ''
set ylabel ''
set key font ',11' spacing 1.0
unset border
unset tics
unset label
plot [1:2][1:2] NaN notitle

reset
unset title
set title '(e) distribution of angles'
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
plot 'gap.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'w = 0.9 mm', \
     'gap.dat' index 1 using 1:2 with lines linecolor '#375a8c' linewidth 1 title 'w = 1.2 mm', \
     'gap.dat' index 2 using 1:2 with lines linecolor '#249f87' linewidth 1 title 'w = 1.4 mm', \
     'gap.dat' index 3 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'w = 1.6 mm'

reset
unset title
set title '(f) distances'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance r (mm)'
set ylabel 'g(r)'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
unset key
plot 'gap.dat' index 4 using 1:2 with lines linecolor '#440154' linewidth 1 title 'w = 0.9 mm', \
     'gap.dat' index 5 using 1:2 with lines linecolor '#375a8c' linewidth 1 title 'w = 1.2 mm', \
     'gap.dat' index 6 using 1:2 with lines linecolor '#249f87' linewidth 1 title 'w = 1.4 mm', \
     'gap.dat' index 7 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'w = 1.6 mm'

reset
unset title
set title '(g) crystal'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'gap between the plates w (mm)'
set ylabel 'crystal measure, {/Symbol y}_6'
set key font ',11' spacing 1.0
set yrange [0:*]
set tmargin 3.5
plot 'gap.dat' index 8 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'gap.dat' index 8 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'Bragg peak', \
     'gap.dat' index 8 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'gap.dat' index 9 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'gap.dat' index 9 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ψ6', \
     'gap.dat' index 9 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
