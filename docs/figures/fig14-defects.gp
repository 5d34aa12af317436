# gnuplot fig14-defects.gp  draws fig14-defects.png from fig14-defects.dat
set terminal pngcairo size 2160,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig14-defects.png'
set multiplot layout 2,3 title "Defects of systems that are ordered here and there" font ',17'

reset
unset title
set title '(a) ℓ = 3 mm, φ = 0.85'
unset border
unset tics
unset key
set size ratio -1
set lmargin 1
set rmargin 1
plot 'fig14-defects-1.png' binary filetype=png with rgbimage notitle

reset
unset title
set title '(b) number, equal to that of charge −1/2'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'time t (s)'
set ylabel 'defects of charge +1/2'
set key font ',11' spacing 1.0
set xrange [0:*]
set yrange [0:*]
plot 'fig14-defects.dat' index 0 using 1:2 with lines linecolor '#355e8c' linewidth 1 title 'ℓ = 3 mm'

reset
unset title
set title '(c) speeds of those that last, where there are most'
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
plot 'fig14-defects.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'fig14-defects.dat' index 1 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'charge +1/2', \
     'fig14-defects.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#287d8e' notitle, \
     'fig14-defects.dat' index 2 using 1:2 with linespoints linecolor '#287d8e' pointtype 7 pointsize 1.2 title 'charge −1/2', \
     'fig14-defects.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'fig14-defects.dat' index 3 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title '+1/2, towards its tail'

reset
unset title
set title '(d) orientational correlation'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance r (mm)'
set ylabel 'G_2(r)'
set key font ',11' spacing 1.0
set xrange [0:*]
set yrange [*<0:*]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
plot 'fig14-defects.dat' index 4 using 1:2 with lines linecolor '#355e8c' linewidth 1 title 'ℓ = 3 mm'
unset multiplot
