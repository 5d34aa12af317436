# gnuplot equilibrium.gp  draws equilibrium.png from equilibrium.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'equilibrium.png'
set multiplot layout 2,2 title "Shaken against equilibrium" font ',17'

reset
unset title
set title '(a) order, ℓ = 4.5 mm'
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
plot 'equilibrium.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'equilibrium.dat' index 0 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'shaken', \
     'equilibrium.dat' index 0 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'equilibrium.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'equilibrium.dat' index 1 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'equilibrium'

reset
unset title
set title '(b) diffusion, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'D / D at the lowest packing'
set key font ',11' spacing 1.0
set yrange [0:*]
set tmargin 3.5
unset key
plot 'equilibrium.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'equilibrium.dat' index 2 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'shaken', \
     'equilibrium.dat' index 2 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'equilibrium.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'equilibrium.dat' index 3 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'equilibrium'

reset
unset title
set title '(c) order, ℓ = 2.5 mm'
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
plot 'equilibrium.dat' index 4 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'equilibrium.dat' index 4 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'shaken', \
     'equilibrium.dat' index 5 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'equilibrium.dat' index 5 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'equilibrium'

reset
unset title
set title '(d) diffusion, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'D / D at the lowest packing'
set key font ',11' spacing 1.0
set yrange [0:*]
set tmargin 3.5
unset key
plot 'equilibrium.dat' index 6 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'equilibrium.dat' index 6 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'shaken', \
     'equilibrium.dat' index 7 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'equilibrium.dat' index 7 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'equilibrium'
unset multiplot
