# gnuplot fig09-diffusion.gp  draws fig09-diffusion.png from fig09-diffusion.dat
set terminal pngcairo size 2160,1730 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig09-diffusion.png'
set multiplot layout 3,3 title "Diffusion" font ',17'

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
set tmargin 4.4
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
set tmargin 4.4
unset key
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
set tmargin 4.4
unset key
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
set title '(d) does it level off?, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag {/Symbol t} (s)'
set ylabel 'MSD / 4t (mm^2/s)'
set key font ',11' spacing 1.0
set logscale x
set format x '10^{%T}'
set xrange [0.1:*]
set yrange [0:*]
set tmargin 5.3
plot 'fig09-diffusion.dat' index 27 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig09-diffusion.dat' index 28 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig09-diffusion.dat' index 29 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig09-diffusion.dat' index 30 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig09-diffusion.dat' index 31 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig09-diffusion.dat' index 32 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig09-diffusion.dat' index 33 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig09-diffusion.dat' index 34 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig09-diffusion.dat' index 35 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85', \
     'fig09-diffusion.dat' index 36 using 1:2 with points linecolor '#440154' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 37 using 1:2 with points linecolor '#472674' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 38 using 1:2 with points linecolor '#3f4686' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 39 using 1:2 with points linecolor '#33638d' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 40 using 1:2 with points linecolor '#287d8e' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 41 using 1:2 with points linecolor '#23978a' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 42 using 1:2 with points linecolor '#2cb07e' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 43 using 1:2 with points linecolor '#59c764' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 44 using 1:2 with points linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'D is read here'

reset
unset title
set title '(e) along the director, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag {/Symbol t} (s)'
set ylabel 'MSD / 2t (mm^2/s)'
set key font ',11' spacing 1.0
set logscale x
set format x '10^{%T}'
set xrange [0.1:*]
set yrange [0:*]
set tmargin 5.3
unset key
plot 'fig09-diffusion.dat' index 45 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig09-diffusion.dat' index 46 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig09-diffusion.dat' index 47 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig09-diffusion.dat' index 48 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig09-diffusion.dat' index 49 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig09-diffusion.dat' index 50 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig09-diffusion.dat' index 51 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig09-diffusion.dat' index 52 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig09-diffusion.dat' index 53 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85', \
     'fig09-diffusion.dat' index 54 using 1:2 with points linecolor '#440154' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 55 using 1:2 with points linecolor '#472674' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 56 using 1:2 with points linecolor '#3f4686' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 57 using 1:2 with points linecolor '#33638d' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 58 using 1:2 with points linecolor '#287d8e' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 59 using 1:2 with points linecolor '#23978a' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 60 using 1:2 with points linecolor '#2cb07e' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 61 using 1:2 with points linecolor '#59c764' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 62 using 1:2 with points linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'D is read here'

reset
unset title
set title '(f) across it, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'lag {/Symbol t} (s)'
set ylabel 'MSD / 2t (mm^2/s)'
set key font ',11' spacing 1.0
set logscale x
set format x '10^{%T}'
set xrange [0.1:*]
set yrange [0:*]
set tmargin 5.3
unset key
plot 'fig09-diffusion.dat' index 63 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig09-diffusion.dat' index 64 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig09-diffusion.dat' index 65 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig09-diffusion.dat' index 66 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig09-diffusion.dat' index 67 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig09-diffusion.dat' index 68 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig09-diffusion.dat' index 69 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig09-diffusion.dat' index 70 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig09-diffusion.dat' index 71 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85', \
     'fig09-diffusion.dat' index 72 using 1:2 with points linecolor '#440154' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 73 using 1:2 with points linecolor '#472674' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 74 using 1:2 with points linecolor '#3f4686' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 75 using 1:2 with points linecolor '#33638d' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 76 using 1:2 with points linecolor '#287d8e' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 77 using 1:2 with points linecolor '#23978a' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 78 using 1:2 with points linecolor '#2cb07e' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 79 using 1:2 with points linecolor '#59c764' pointtype 7 pointsize 1.2 notitle, \
     'fig09-diffusion.dat' index 80 using 1:2 with points linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'D is read here'

reset
unset title
set title '(g) diffusion constant, ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'D = MSD / 4t (mm^2/s)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig09-diffusion.dat' index 81 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig09-diffusion.dat' index 81 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'long times', \
     'fig09-diffusion.dat' index 82 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig09-diffusion.dat' index 82 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'short times', \
     'fig09-diffusion.dat' index 83 using 1:2 with lines linecolor '#9ad83c' linewidth 1 dashtype 2 title 'Sharma & Soni''s fit'

reset
unset title
set title '(h) along and across the director, ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel 'D (mm^2/s)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig09-diffusion.dat' index 84 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig09-diffusion.dat' index 84 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'along', \
     'fig09-diffusion.dat' index 84 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig09-diffusion.dat' index 85 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig09-diffusion.dat' index 85 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'across', \
     'fig09-diffusion.dat' index 85 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(i) normal diffusion: 1'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 3
set xlabel 'area fraction φ'
set ylabel 'exponent {/Symbol a} of the MSD'
set key font ',11' spacing 1.0
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
plot 'fig09-diffusion.dat' index 86 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig09-diffusion.dat' index 86 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'short rods, short times', \
     'fig09-diffusion.dat' index 87 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig09-diffusion.dat' index 87 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'long rods, along', \
     'fig09-diffusion.dat' index 87 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle, \
     'fig09-diffusion.dat' index 88 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig09-diffusion.dat' index 88 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'long rods, across', \
     'fig09-diffusion.dat' index 88 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle
unset multiplot
