# gnuplot melting.gp  draws melting.png from melting.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'melting.png'
set multiplot layout 2,2 title "Defects and melting" font ',17'

reset
unset title
set title '(a) defect density'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'defects per area (1/mm^2)'
set key font ',11' spacing 1.0
set yrange [0:*]
set tmargin 3.5
plot 'melting.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'melting.dat' index 0 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'melting.dat' index 0 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'melting.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3f4686' notitle, \
     'melting.dat' index 1 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'melting.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'melting.dat' index 2 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'melting.dat' index 2 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'melting.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#2cb07e' notitle, \
     'melting.dat' index 3 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'melting.dat' index 4 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'melting.dat' index 4 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'melting.dat' index 4 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(b) defect density against order'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel '⟨S⟩'
set ylabel 'defects per area (1/mm^2)'
set key font ',11' spacing 1.0
set xrange [0:1]
set yrange [0:*]
set tmargin 3.5
unset key
plot 'melting.dat' index 5 using 1:2 with points linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'melting.dat' index 6 using 1:2 with points linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'melting.dat' index 7 using 1:2 with points linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'melting.dat' index 8 using 1:2 with points linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'melting.dat' index 9 using 1:2 with points linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm'

reset
unset title
set title '(c) speeds of +1/2 and −1/2'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'time over which a core''s way is taken (s)'
set ylabel 'mean speed (mm/s)'
set key font ',11' spacing 1.0
set logscale x 2
set xzeroaxis linecolor '#999999'
plot 'melting.dat' index 10 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'melting.dat' index 10 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'charge +1/2', \
     'melting.dat' index 11 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'melting.dat' index 11 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'charge −1/2', \
     'melting.dat' index 12 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'melting.dat' index 12 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title '+1/2, towards its tail'

reset
unset title
set title '(d) order'
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
plot 'melting.dat' index 13 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'melting.dat' index 13 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'melting.dat' index 14 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3f4686' notitle, \
     'melting.dat' index 14 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'melting.dat' index 15 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'melting.dat' index 15 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'melting.dat' index 15 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'melting.dat' index 16 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#2cb07e' notitle, \
     'melting.dat' index 16 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'melting.dat' index 17 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'melting.dat' index 17 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'melting.dat' index 17 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
