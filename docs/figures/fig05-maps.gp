# gnuplot fig05-maps.gp  draws fig05-maps.png from fig05-maps.dat
set terminal pngcairo size 1440,1730 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig05-maps.png'
set multiplot layout 3,2 title "Correlations along and across the director" font ',17'

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
plot 'fig05-maps.dat' index 0 using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle

reset
unset title
set title '(b) g(x, y), ℓ = 4.5 mm, φ = 0.75'
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
set cbrange [0:2.5]
plot 'fig05-maps.dat' index 1 using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle

reset
unset title
set title '(c) cuts through (a)'
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
plot 'fig05-maps.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig05-maps.dat' index 2 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig05-maps.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig05-maps.dat' index 3 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'

reset
unset title
set title '(d) cuts through (b)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance (mm)'
set ylabel 'g'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
unset key
plot 'fig05-maps.dat' index 4 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig05-maps.dat' index 4 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig05-maps.dat' index 5 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig05-maps.dat' index 5 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'

reset
unset title
set title '(e) cuts at φ = 0.45'
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
plot 'fig05-maps.dat' index 6 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig05-maps.dat' index 6 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig05-maps.dat' index 7 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig05-maps.dat' index 7 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'

reset
unset title
set title '(f) cuts at φ = 0.45'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance (mm)'
set ylabel 'g'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
unset key
plot 'fig05-maps.dat' index 8 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig05-maps.dat' index 8 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig05-maps.dat' index 9 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig05-maps.dat' index 9 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'
unset multiplot
