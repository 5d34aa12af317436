# gnuplot fig13-rotation.gp  draws fig13-rotation.png from fig13-rotation.dat
set terminal pngcairo size 2160,610 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig13-rotation.png'
set multiplot layout 1,3 title "Rotation" font ',17'

reset
unset title
set title '(a) rotation, ℓ = 2.5 mm'
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
plot 'fig13-rotation.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig13-rotation.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig13-rotation.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig13-rotation.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig13-rotation.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig13-rotation.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig13-rotation.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig13-rotation.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig13-rotation.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) rotation, ℓ = 4.5 mm'
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
plot 'fig13-rotation.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig13-rotation.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig13-rotation.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig13-rotation.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig13-rotation.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig13-rotation.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig13-rotation.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig13-rotation.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig13-rotation.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(c) rotational diffusion'
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
plot 'fig13-rotation.dat' index 18 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig13-rotation.dat' index 18 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'ℓ = 2.5 mm', \
     'fig13-rotation.dat' index 19 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#3f4686' notitle, \
     'fig13-rotation.dat' index 19 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'ℓ = 3 mm', \
     'fig13-rotation.dat' index 20 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig13-rotation.dat' index 20 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'ℓ = 3.5 mm', \
     'fig13-rotation.dat' index 20 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig13-rotation.dat' index 21 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#2cb07e' notitle, \
     'fig13-rotation.dat' index 21 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'ℓ = 4 mm', \
     'fig13-rotation.dat' index 22 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig13-rotation.dat' index 22 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'ℓ = 4.5 mm', \
     'fig13-rotation.dat' index 22 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
