# gnuplot fig10-tilt.gp  draws fig10-tilt.png from fig10-tilt.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig10-tilt.png'
set multiplot layout 2,2 title "How a rod swims" font ',17'

reset
unset title
set title '(a) velocity along the rod, φ = 0.6'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'tilt n_z'
set ylabel '⟨v^n⟩ along the rod (mm/s)'
set key font ',11' spacing 1.0
set xzeroaxis linecolor '#999999'
set yzeroaxis linecolor '#999999'
plot 'fig10-tilt.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'fig10-tilt.dat' index 0 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle

reset
unset title
set title '(b) velocity across the rod, φ = 0.6'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'tilt n_z'
set ylabel '⟨v^t⟩ across the rod (mm/s)'
set key font ',11' spacing 1.0
set xzeroaxis linecolor '#999999'
set yzeroaxis linecolor '#999999'
plot 'fig10-tilt.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'fig10-tilt.dat' index 1 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle

reset
unset title
set title '(c) how often a tilt occurs'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'tilt n_z'
set ylabel 'P(n_z)'
set key font ',11' spacing 1.0
set yrange [0:*]
plot 'fig10-tilt.dat' index 2 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.6', \
     'fig10-tilt.dat' index 3 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig10-tilt.dat' index 4 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(d) tilt of one rod, φ = 0.6'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'time t (s)'
set ylabel 'tilt n_z'
set key font ',11' spacing 1.0
set xrange [*:*] noextend
set yrange [-0.4:0.4]
plot 'fig10-tilt.dat' index 5 using 1:2 with lines linecolor '#355e8c' linewidth 1 notitle
unset multiplot
