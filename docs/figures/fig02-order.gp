# gnuplot fig02-order.gp  draws fig02-order.png from fig02-order.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig02-order.png'
set multiplot layout 2,2 title "Nematic order" font ',17'

reset
unset title
set title '(a) from the aligned start, longest rods'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'time t (s)'
set ylabel 'nematic order S'
set key font ',11' spacing 1.0
set xrange [0:*]
set yrange [0:1]
plot 'fig02-order.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig02-order.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig02-order.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig02-order.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig02-order.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig02-order.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig02-order.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig02-order.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig02-order.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) mean order'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel '⟨S⟩; bars: standard deviation of S(t)'
set key font ',11' spacing 1.0
set yrange [0:1]
set arrow from graph 0, first 0.5 to graph 1, first 0.5 nohead linecolor '#999999' dashtype 2 back
plot 'fig02-order.dat' index 9 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig02-order.dat' index 9 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'fig02-order.dat' index 10 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3f4686' notitle, \
     'fig02-order.dat' index 10 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'fig02-order.dat' index 11 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig02-order.dat' index 11 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'fig02-order.dat' index 11 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig02-order.dat' index 12 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#2cb07e' notitle, \
     'fig02-order.dat' index 12 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'fig02-order.dat' index 13 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig02-order.dat' index 13 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'fig02-order.dat' index 13 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(c) phase diagram'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'rod length ℓ (mm)'
set palette defined (0 '#440154', 0.25 '#3b528b', 0.5 '#21918c', 0.75 '#5ec962', 1 '#fde725')
unset grid
set size ratio -1
set autoscale xfix
set autoscale yfix
set key font ',11' spacing 1.0
set cbrange [0:1]
set size noratio
set cblabel '⟨S⟩'
plot 'fig02-order.dat' index 14 using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle, \
     'fig02-order.dat' index 15 using 1:2 with points linecolor '#355e8c' pointtype 7 pointsize 1.2 title '⟨S⟩ = 0.5', \
     'fig02-order.dat' index 15 using 1:($3==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(d) fluctuations of the order'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'standard deviation of S(t)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig02-order.dat' index 16 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'fig02-order.dat' index 17 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'fig02-order.dat' index 18 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'fig02-order.dat' index 18 using 1:($3==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig02-order.dat' index 19 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'fig02-order.dat' index 20 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'fig02-order.dat' index 20 using 1:($3==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
