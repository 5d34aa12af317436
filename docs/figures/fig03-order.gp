# gnuplot fig03-order.gp  draws fig03-order.png from fig03-order.dat
set terminal pngcairo size 1440,610 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig03-order.png'
set multiplot layout 1,2 title "Nematic order" font ',17'

reset
unset title
set title '(a) mean order'
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
plot 'fig03-order.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig03-order.dat' index 0 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'fig03-order.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3f4686' notitle, \
     'fig03-order.dat' index 1 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'fig03-order.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig03-order.dat' index 2 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'fig03-order.dat' index 2 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig03-order.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#2cb07e' notitle, \
     'fig03-order.dat' index 3 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'fig03-order.dat' index 4 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig03-order.dat' index 4 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'fig03-order.dat' index 4 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(b) phase diagram'
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
plot 'fig03-order.dat' index 5 using 1:2:4:5:6:7:3 with boxxyerror fillstyle solid noborder palette notitle, \
     'fig03-order.dat' index 6 using 1:2 with points linecolor '#355e8c' pointtype 7 pointsize 1.2 title '⟨S⟩ = 0.5', \
     'fig03-order.dat' index 6 using 1:($3==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
