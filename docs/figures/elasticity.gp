# gnuplot elasticity.gp  draws elasticity.png from elasticity.dat
set terminal pngcairo size 1440,610 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'elasticity.png'
set multiplot layout 1,2 title "Director fluctuations" font ',17'

reset
unset title
set title '(a) from the spectrum of the director'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'area fraction φ'
set ylabel 'K_3 / K_1 (bend / splay)'
set key font ',11' spacing 1.0
set yrange [0:*]
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
plot 'elasticity.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'elasticity.dat' index 0 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle

reset
unset title
set title '(b) least packed of the layered runs'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'wave number q (1/mm)'
set ylabel '⟨|{/Symbol dq}_q|^2⟩'
set key font ',11' spacing 1.0
set logscale xy
plot 'elasticity.dat' index 1 using 1:2 with points linecolor '#440154' pointtype 7 pointsize 1.2 title 'along: bend', \
     'elasticity.dat' index 2 using 1:2 with points linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'across: splay'
unset multiplot
