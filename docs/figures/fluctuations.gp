# gnuplot fluctuations.gp  draws fluctuations.png from fluctuations.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fluctuations.png'
set multiplot layout 2,2 title "Number fluctuations" font ',17'

reset
unset title
set title '(a) longest rods'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'mean number in a box ⟨N⟩'
set ylabel 'standard deviation {/Symbol D}N'
set key font ',11' spacing 1.0
set logscale xy
set tmargin 6.3
plot 'fluctuations.dat' index 0 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'φ = 0.45', \
     'fluctuations.dat' index 1 using 1:2 with linespoints linecolor '#462171' pointtype 7 pointsize 1.2 title 'φ = 0.5', \
     'fluctuations.dat' index 2 using 1:2 with linespoints linecolor '#413f83' pointtype 7 pointsize 1.2 title 'φ = 0.55', \
     'fluctuations.dat' index 3 using 1:2 with linespoints linecolor '#375a8c' pointtype 7 pointsize 1.2 title 'φ = 0.6', \
     'fluctuations.dat' index 4 using 1:2 with linespoints linecolor '#2c728e' pointtype 7 pointsize 1.2 title 'φ = 0.65', \
     'fluctuations.dat' index 5 using 1:2 with linespoints linecolor '#23898d' pointtype 7 pointsize 1.2 title 'φ = 0.7', \
     'fluctuations.dat' index 6 using 1:2 with linespoints linecolor '#249f87' pointtype 7 pointsize 1.2 title 'φ = 0.75', \
     'fluctuations.dat' index 7 using 1:2 with linespoints linecolor '#36b578' pointtype 7 pointsize 1.2 title 'φ = 0.8', \
     'fluctuations.dat' index 8 using 1:2 with linespoints linecolor '#5fc961' pointtype 7 pointsize 1.2 title 'φ = 0.85', \
     'fluctuations.dat' index 9 using 1:2 with lines linecolor '#9ad83c' linewidth 1 dashtype 2 title '√N: independent'

reset
unset title
set title '(b) longest rods, mean density map removed'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'mean number in a box ⟨N⟩'
set ylabel 'standard deviation {/Symbol D}N'
set key font ',11' spacing 1.0
set logscale xy
set tmargin 6.3
unset key
plot 'fluctuations.dat' index 10 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'φ = 0.45', \
     'fluctuations.dat' index 11 using 1:2 with linespoints linecolor '#462171' pointtype 7 pointsize 1.2 title 'φ = 0.5', \
     'fluctuations.dat' index 12 using 1:2 with linespoints linecolor '#413f83' pointtype 7 pointsize 1.2 title 'φ = 0.55', \
     'fluctuations.dat' index 13 using 1:2 with linespoints linecolor '#375a8c' pointtype 7 pointsize 1.2 title 'φ = 0.6', \
     'fluctuations.dat' index 14 using 1:2 with linespoints linecolor '#2c728e' pointtype 7 pointsize 1.2 title 'φ = 0.65', \
     'fluctuations.dat' index 15 using 1:2 with linespoints linecolor '#23898d' pointtype 7 pointsize 1.2 title 'φ = 0.7', \
     'fluctuations.dat' index 16 using 1:2 with linespoints linecolor '#249f87' pointtype 7 pointsize 1.2 title 'φ = 0.75', \
     'fluctuations.dat' index 17 using 1:2 with linespoints linecolor '#36b578' pointtype 7 pointsize 1.2 title 'φ = 0.8', \
     'fluctuations.dat' index 18 using 1:2 with linespoints linecolor '#5fc961' pointtype 7 pointsize 1.2 title 'φ = 0.85', \
     'fluctuations.dat' index 19 using 1:2 with lines linecolor '#9ad83c' linewidth 1 dashtype 2 title '√N: independent'

reset
unset title
set title '(c) shortest rods, map removed'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'mean number in a box ⟨N⟩'
set ylabel 'standard deviation {/Symbol D}N'
set key font ',11' spacing 1.0
set logscale xy
plot 'fluctuations.dat' index 20 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'φ = 0.45', \
     'fluctuations.dat' index 21 using 1:2 with linespoints linecolor '#462171' pointtype 7 pointsize 1.2 title 'φ = 0.5', \
     'fluctuations.dat' index 22 using 1:2 with linespoints linecolor '#413f83' pointtype 7 pointsize 1.2 title 'φ = 0.55', \
     'fluctuations.dat' index 23 using 1:2 with linespoints linecolor '#375a8c' pointtype 7 pointsize 1.2 title 'φ = 0.6', \
     'fluctuations.dat' index 24 using 1:2 with linespoints linecolor '#2c728e' pointtype 7 pointsize 1.2 title 'φ = 0.65', \
     'fluctuations.dat' index 25 using 1:2 with linespoints linecolor '#23898d' pointtype 7 pointsize 1.2 title 'φ = 0.7', \
     'fluctuations.dat' index 26 using 1:2 with linespoints linecolor '#249f87' pointtype 7 pointsize 1.2 title 'φ = 0.75', \
     'fluctuations.dat' index 27 using 1:2 with linespoints linecolor '#36b578' pointtype 7 pointsize 1.2 title 'φ = 0.8', \
     'fluctuations.dat' index 28 using 1:2 with linespoints linecolor '#5fc961' pointtype 7 pointsize 1.2 title 'φ = 0.85', \
     'fluctuations.dat' index 29 using 1:2 with lines linecolor '#9ad83c' linewidth 1 dashtype 2 title '√N: independent'

reset
unset title
set title '(d) longest rods in equilibrium, map removed'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'mean number in a box ⟨N⟩'
set ylabel 'standard deviation {/Symbol D}N'
set key font ',11' spacing 1.0
set logscale xy
plot 'fluctuations.dat' index 30 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'φ = 0.45', \
     'fluctuations.dat' index 31 using 1:2 with linespoints linecolor '#3f4686' pointtype 7 pointsize 1.2 title 'φ = 0.55', \
     'fluctuations.dat' index 32 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'φ = 0.65', \
     'fluctuations.dat' index 33 using 1:2 with linespoints linecolor '#2cb07e' pointtype 7 pointsize 1.2 title 'φ = 0.75', \
     'fluctuations.dat' index 34 using 1:2 with lines linecolor '#9ad83c' linewidth 1 dashtype 2 title '√N: independent'
unset multiplot
