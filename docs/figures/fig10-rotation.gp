# gnuplot fig10-rotation.gp  draws fig10-rotation.png from fig10-rotation.dat
set terminal pngcairo size 2160,1730 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig10-rotation.png'
set multiplot layout 3,3 title "Correlations in time" font ',17'

reset
unset title
set title '(a) velocity, ℓ = 2.5 mm'
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
plot 'fig10-rotation.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig10-rotation.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig10-rotation.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig10-rotation.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig10-rotation.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-rotation.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig10-rotation.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig10-rotation.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig10-rotation.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) velocity, ℓ = 4.5 mm'
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
plot 'fig10-rotation.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig10-rotation.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig10-rotation.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig10-rotation.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig10-rotation.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-rotation.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig10-rotation.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig10-rotation.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig10-rotation.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(c) orientation, ℓ = 2.5 mm'
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
plot 'fig10-rotation.dat' index 18 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig10-rotation.dat' index 19 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig10-rotation.dat' index 20 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig10-rotation.dat' index 21 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig10-rotation.dat' index 22 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-rotation.dat' index 23 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig10-rotation.dat' index 24 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig10-rotation.dat' index 25 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig10-rotation.dat' index 26 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(d) orientation, ℓ = 4.5 mm'
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
plot 'fig10-rotation.dat' index 27 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig10-rotation.dat' index 28 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig10-rotation.dat' index 29 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig10-rotation.dat' index 30 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig10-rotation.dat' index 31 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-rotation.dat' index 32 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig10-rotation.dat' index 33 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig10-rotation.dat' index 34 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig10-rotation.dat' index 35 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(e) rotation, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag t (s)'
set ylabel 'mean square angular displacement (rad^2)'
set key font ',11' spacing 1.0
set logscale xy
set format xy '10^{%T}'
set tmargin 4.4
unset key
plot 'fig10-rotation.dat' index 36 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig10-rotation.dat' index 37 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig10-rotation.dat' index 38 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig10-rotation.dat' index 39 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig10-rotation.dat' index 40 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-rotation.dat' index 41 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig10-rotation.dat' index 42 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig10-rotation.dat' index 43 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig10-rotation.dat' index 44 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(f) rotational diffusion'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'D_r (rad^2/s)'
set key font ',11' spacing 1.0
set logscale y
set tmargin 4.4
plot 'fig10-rotation.dat' index 45 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig10-rotation.dat' index 45 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'fig10-rotation.dat' index 46 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3f4686' notitle, \
     'fig10-rotation.dat' index 46 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'fig10-rotation.dat' index 47 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig10-rotation.dat' index 47 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'fig10-rotation.dat' index 47 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig10-rotation.dat' index 48 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#2cb07e' notitle, \
     'fig10-rotation.dat' index 48 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'fig10-rotation.dat' index 49 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig10-rotation.dat' index 49 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'fig10-rotation.dat' index 49 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(g) rotation, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag t (s)'
set ylabel 'mean square angular displacement (rad^2)'
set key font ',11' spacing 1.0
set logscale xy
set format xy '10^{%T}'
plot 'fig10-rotation.dat' index 50 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig10-rotation.dat' index 51 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig10-rotation.dat' index 52 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig10-rotation.dat' index 53 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig10-rotation.dat' index 54 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-rotation.dat' index 55 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig10-rotation.dat' index 56 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig10-rotation.dat' index 57 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig10-rotation.dat' index 58 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(h) what of the orientation stays, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'area fraction φ'
set ylabel 'plateau of C_2'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig10-rotation.dat' index 59 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'fig10-rotation.dat' index 59 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle, \
     'fig10-rotation.dat' index 59 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(i) variance of the velocity, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'C_v(0) (mm^2/s^2)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig10-rotation.dat' index 60 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig10-rotation.dat' index 60 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'along the director', \
     'fig10-rotation.dat' index 60 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig10-rotation.dat' index 61 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig10-rotation.dat' index 61 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'across', \
     'fig10-rotation.dat' index 61 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
