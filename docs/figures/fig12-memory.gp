# gnuplot fig12-memory.gp  draws fig12-memory.png from fig12-memory.dat
set terminal pngcairo size 2160,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig12-memory.png'
set multiplot layout 2,3 title "Correlations in time" font ',17'

reset
unset title
set title '(a) orientation, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag t (s)'
set ylabel 'C_2(t)'
set key font ',11' spacing 1.0
set logscale x
set format x '10^{%T}'
set yrange [-0.2:1.05]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
plot 'fig12-memory.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig12-memory.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig12-memory.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig12-memory.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig12-memory.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig12-memory.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig12-memory.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig12-memory.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig12-memory.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) orientation, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag t (s)'
set ylabel 'C_2(t)'
set key font ',11' spacing 1.0
set logscale x
set format x '10^{%T}'
set yrange [-0.2:1.05]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
unset key
plot 'fig12-memory.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig12-memory.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig12-memory.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig12-memory.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig12-memory.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig12-memory.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig12-memory.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig12-memory.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig12-memory.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(c) what of the orientation stays, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'area fraction φ'
set ylabel 'plateau of C_2'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig12-memory.dat' index 18 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'fig12-memory.dat' index 18 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle, \
     'fig12-memory.dat' index 18 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(d) velocity, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag t (s)'
set ylabel 'C_v(t)'
set key font ',11' spacing 1.0
set xrange [0:5]
set yrange [-0.2:1.05]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
plot 'fig12-memory.dat' index 19 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig12-memory.dat' index 20 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig12-memory.dat' index 21 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig12-memory.dat' index 22 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig12-memory.dat' index 23 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig12-memory.dat' index 24 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig12-memory.dat' index 25 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig12-memory.dat' index 26 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig12-memory.dat' index 27 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(e) velocity, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag t (s)'
set ylabel 'C_v(t) along the director'
set key font ',11' spacing 1.0
set xrange [0:5]
set yrange [-0.2:1.05]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
unset key
plot 'fig12-memory.dat' index 28 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig12-memory.dat' index 29 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig12-memory.dat' index 30 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig12-memory.dat' index 31 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig12-memory.dat' index 32 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig12-memory.dat' index 33 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig12-memory.dat' index 34 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig12-memory.dat' index 35 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig12-memory.dat' index 36 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(f) variance of the velocity, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'C_v(0) (mm^2/s^2)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig12-memory.dat' index 37 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig12-memory.dat' index 37 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'along the director', \
     'fig12-memory.dat' index 37 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig12-memory.dat' index 38 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig12-memory.dat' index 38 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'across', \
     'fig12-memory.dat' index 38 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
