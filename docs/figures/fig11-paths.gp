# gnuplot fig11-paths.gp  draws fig11-paths.png from fig11-paths.dat
set terminal pngcairo size 2160,610 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig11-paths.png'
set multiplot layout 1,3 title "Paths of single rods" font ',17'

reset
unset title
set title '(a) paths, φ = 0.65'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'x (mm)'
set ylabel 'y (mm)'
set key font ',11' spacing 1.0
set size ratio 1
set xrange [-12.953445239870463:11.050789792651171]
set yrange [-11.147216754684713:12.857018277836922]
plot 'fig11-paths.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 notitle, \
     'fig11-paths.dat' index 1 using 1:2 with lines linecolor '#375a8c' linewidth 1 notitle, \
     'fig11-paths.dat' index 2 using 1:2 with lines linecolor '#249f87' linewidth 1 notitle, \
     'fig11-paths.dat' index 3 using 1:2 with lines linecolor '#9ad83c' linewidth 1 notitle

reset
unset title
set title '(b) paths, φ = 0.85'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'x (mm)'
set ylabel 'y (mm)'
set key font ',11' spacing 1.0
set size ratio 1
set xrange [-35.98994744272535:50.48177551800744]
set yrange [-46.71746342367278:39.75425953706001]
plot 'fig11-paths.dat' index 4 using 1:2 with lines linecolor '#440154' linewidth 1 notitle, \
     'fig11-paths.dat' index 5 using 1:2 with lines linecolor '#375a8c' linewidth 1 notitle, \
     'fig11-paths.dat' index 6 using 1:2 with lines linecolor '#249f87' linewidth 1 notitle, \
     'fig11-paths.dat' index 7 using 1:2 with lines linecolor '#9ad83c' linewidth 1 notitle

reset
unset title
set title '(c) how long rods keep their way'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'time (s)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig11-paths.dat' index 8 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig11-paths.dat' index 8 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'a way persists', \
     'fig11-paths.dat' index 9 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig11-paths.dat' index 9 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'a tilt keeps its sign'
unset multiplot
