# gnuplot fig09-diffusion.gp  draws fig09-diffusion.png from fig09-diffusion.dat
set terminal pngcairo size 2160,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig09-diffusion.png'
set multiplot layout 2,3 title "Diffusion" font ',17'

reset
unset title
set title '(a) in the plane, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag {/Symbol t} (s)'
set ylabel 'mean square displacement (mm^2)'
set key font ',11' spacing 1.0
set logscale xy
set format xy '10^{%T}'
plot 'fig09-diffusion.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig09-diffusion.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig09-diffusion.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig09-diffusion.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig09-diffusion.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig09-diffusion.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig09-diffusion.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig09-diffusion.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig09-diffusion.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) along the director, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag {/Symbol t} (s)'
set ylabel 'mean square displacement (mm^2)'
set key font ',11' spacing 1.0
set logscale xy
set format xy '10^{%T}'
plot 'fig09-diffusion.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig09-diffusion.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig09-diffusion.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig09-diffusion.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig09-diffusion.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig09-diffusion.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig09-diffusion.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig09-diffusion.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig09-diffusion.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(c) across it, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag {/Symbol t} (s)'
set ylabel 'mean square displacement (mm^2)'
set key font ',11' spacing 1.0
set logscale xy
set format xy '10^{%T}'
plot 'fig09-diffusion.dat' index 18 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig09-diffusion.dat' index 19 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig09-diffusion.dat' index 20 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig09-diffusion.dat' index 21 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig09-diffusion.dat' index 22 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig09-diffusion.dat' index 23 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig09-diffusion.dat' index 24 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig09-diffusion.dat' index 25 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig09-diffusion.dat' index 26 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(d) diffusion constant, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'D = MSD / 4t (mm^2/s)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig09-diffusion.dat' index 27 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig09-diffusion.dat' index 27 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'long times', \
     'fig09-diffusion.dat' index 28 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig09-diffusion.dat' index 28 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'short times', \
     'fig09-diffusion.dat' index 29 using 1:2 with lines linecolor '#9ad83c' linewidth 1 dashtype 2 title 'Sharma & Soni''s fit'

reset
unset title
set title '(e) along and across the director, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'D (mm^2/s)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig09-diffusion.dat' index 30 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig09-diffusion.dat' index 30 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'along', \
     'fig09-diffusion.dat' index 31 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig09-diffusion.dat' index 31 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'across'

reset
unset title
set title '(f) normal diffusion: 1'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'exponent {/Symbol a} of the MSD'
set key font ',11' spacing 1.0
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
plot 'fig09-diffusion.dat' index 32 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig09-diffusion.dat' index 32 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'short rods, short times', \
     'fig09-diffusion.dat' index 33 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig09-diffusion.dat' index 33 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'long rods, along', \
     'fig09-diffusion.dat' index 34 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig09-diffusion.dat' index 34 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'long rods, across'
unset multiplot
