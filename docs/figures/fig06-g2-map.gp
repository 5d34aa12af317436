# gnuplot fig06-g2-map.gp  draws fig06-g2-map.png from fig06-g2-map.dat
set terminal pngcairo size 2160,610 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig06-g2-map.png'
set multiplot layout 1,3 title "Orientational correlation along and across the director" font ',17'

reset
unset title
set title '(a) G_2(x, y), ℓ = 4.5 mm, φ = 0.75'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'along the director (mm)'
set ylabel 'across (mm)'
set palette defined (0 '#440154', 0.25 '#3b528b', 0.5 '#21918c', 0.75 '#5ec962', 1 '#fde725')
unset grid
set size ratio -1
set autoscale xfix
set autoscale yfix
set key font ',11' spacing 1.0
set cbrange [0:1]
plot 'fig06-g2-map.dat' index 0 using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle

reset
unset title
set title '(b) cuts through (a)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance (mm)'
set ylabel 'G_2'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
plot 'fig06-g2-map.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig06-g2-map.dat' index 1 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig06-g2-map.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig06-g2-map.dat' index 2 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'

reset
unset title
set title '(c) cuts at φ = 0.45'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance (mm)'
set ylabel 'G_2'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
unset key
plot 'fig06-g2-map.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig06-g2-map.dat' index 3 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig06-g2-map.dat' index 4 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig06-g2-map.dat' index 4 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'
unset multiplot
