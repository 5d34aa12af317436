# gnuplot size.gp  draws size.png from size.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'size.png'
set multiplot layout 2,2 title "Order against the size of the box" font ',17'

reset
unset title
set title '(a) order'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel '⟨S⟩'
set key font ',11' spacing 1.0
set yrange [0:1]
set arrow from graph 0, first 0.5 to graph 1, first 0.5 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
plot 'size.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'size.dat' index 0 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'L = 16.75 mm', \
     'size.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'size.dat' index 1 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'L = 33.49 mm', \
     'size.dat' index 1 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'size.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'size.dat' index 2 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'L = 66.98 mm'

reset
unset title
set title '(b) Binder cumulant'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'Binder cumulant'
set key font ',11' spacing 1.0
set yrange [-0.2:1.1]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
set tmargin 3.5
unset key
plot 'size.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'size.dat' index 3 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'L = 16.75 mm', \
     'size.dat' index 3 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'size.dat' index 4 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'size.dat' index 4 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'L = 33.49 mm', \
     'size.dat' index 4 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'size.dat' index 5 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'size.dat' index 5 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'L = 66.98 mm'

reset
unset title
set title '(c) order against size: level, a small power, or 1/L'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'side of the box L (mm)'
set ylabel '⟨S⟩'
set key font ',11' spacing 1.0
set logscale xy
set xtics (10, 20, 40, 80, 160)
plot 'size.dat' index 6 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'size.dat' index 6 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'φ = 0.45', \
     'size.dat' index 7 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#433980' notitle, \
     'size.dat' index 7 using 1:2 with linespoints linecolor '#433980' pointtype 7 pointsize 1.2 title 'φ = 0.5', \
     'size.dat' index 8 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#30688d' notitle, \
     'size.dat' index 8 using 1:2 with linespoints linecolor '#30688d' pointtype 7 pointsize 1.2 title 'φ = 0.55', \
     'size.dat' index 8 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'size.dat' index 9 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#21928c' notitle, \
     'size.dat' index 9 using 1:2 with linespoints linecolor '#21928c' pointtype 7 pointsize 1.2 title 'φ = 0.6', \
     'size.dat' index 10 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3eb974' notitle, \
     'size.dat' index 10 using 1:2 with linespoints linecolor '#3eb974' pointtype 7 pointsize 1.2 title 'φ = 0.65', \
     'size.dat' index 11 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'size.dat' index 11 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'φ = 0.7'

reset
unset title
set title '(d) where ⟨S⟩ passes 0.5'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'side of the box L (mm)'
set ylabel 'area fraction φ'
set key font ',11' spacing 1.0
set logscale x
set xtics (10, 20, 40, 80, 160)
plot 'size.dat' index 12 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'size.dat' index 12 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle, \
     'size.dat' index 12 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
