# gnuplot fig07-distances.gp  draws fig07-distances.png from fig07-distances.dat
set terminal pngcairo size 2160,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig07-distances.png'
set multiplot layout 2,3 title "Pair correlation" font ',17'

reset
unset title
set title '(a) shortest rods, ℓ = 2.5 mm'
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
set tmargin 4.4
plot 'fig07-distances.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig07-distances.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig07-distances.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig07-distances.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig07-distances.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig07-distances.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig07-distances.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig07-distances.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig07-distances.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) longest rods, ℓ = 4.5 mm'
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
set tmargin 4.4
unset key
plot 'fig07-distances.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig07-distances.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig07-distances.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig07-distances.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig07-distances.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig07-distances.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig07-distances.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig07-distances.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig07-distances.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set border 3 linecolor '#333333'
unset border
unset tics
unset label
plot [1:2][1:2] NaN notitle

reset
unset title
set title '(c) g(x, y), ℓ = 4.5 mm, φ = 0.75'
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
plot 'fig07-distances.dat' index 18 using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle

reset
unset title
set title '(d) cuts through (c)'
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
plot 'fig07-distances.dat' index 19 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig07-distances.dat' index 19 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig07-distances.dat' index 20 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig07-distances.dat' index 20 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'

reset
unset title
set title '(e) cuts at φ = 0.45'
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
plot 'fig07-distances.dat' index 21 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig07-distances.dat' index 21 using 1:2 with lines linecolor '#440154' linewidth 1 title 'along', \
     'fig07-distances.dat' index 22 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig07-distances.dat' index 22 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'across'
unset multiplot
