# gnuplot layer-trends.gp  draws layer-trends.png from layer-trends.dat
set terminal pngcairo size 2160,1730 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'layer-trends.png'
set multiplot layout 3,3 title "Angle and wavelength of the layers" font ',17'

reset
unset title
set title '(a)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'area fraction φ'
set ylabel '{/Symbol q}_m (degrees)'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [0.74:0.86]
set tmargin 3.5
plot 'layer-trends.dat' index 0 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'layer-trends.dat' index 0 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'fitted', \
     'layer-trends.dat' index 1 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'layer-trends.dat' index 1 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'maximum'

reset
unset title
set title '(b)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'rod length ℓ (mm)'
set ylabel '{/Symbol q}_m (degrees)'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [3.4:4.6]
set tmargin 3.5
unset key
plot 'layer-trends.dat' index 2 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#440154' notitle, \
     'layer-trends.dat' index 2 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'fitted', \
     'layer-trends.dat' index 3 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'layer-trends.dat' index 3 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'maximum'

reset
unset title
set title '(c)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'end diameter d′ (mm)'
set ylabel '{/Symbol q}_m (degrees)'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [0.38:0.62]
set tmargin 3.5
unset key
plot 'layer-trends.dat' index 4 using 1:2 with linespoints linecolor '#440154' pointtype 7 pointsize 1.2 title 'fitted', \
     'layer-trends.dat' index 5 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#9ad83c' notitle, \
     'layer-trends.dat' index 5 using 1:2 with linespoints linecolor '#9ad83c' pointtype 7 pointsize 1.2 title 'maximum'

reset
unset title
set title '(d)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'area fraction φ'
set ylabel 'wavelength {/Symbol l} (mm)'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [0.74:0.86]
plot 'layer-trends.dat' index 6 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'layer-trends.dat' index 6 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle

reset
unset title
set title '(e)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'rod length ℓ (mm)'
set ylabel 'wavelength {/Symbol l} (mm)'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [3.4:4.6]
plot 'layer-trends.dat' index 7 using 1:2:3 with yerrorbars pointtype 7 pointsize 0 linecolor '#355e8c' notitle, \
     'layer-trends.dat' index 7 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle

reset
unset title
set title '(f)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'end diameter d′ (mm)'
set ylabel 'wavelength {/Symbol l} (mm)'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [0.38:0.62]
plot 'layer-trends.dat' index 8 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle

reset
unset title
set title '(g)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'area fraction φ'
set ylabel 'order of the layers'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [0.74:0.86]
plot 'layer-trends.dat' index 9 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle, \
     'layer-trends.dat' index 9 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(h)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'rod length ℓ (mm)'
set ylabel 'order of the layers'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [3.4:4.6]
plot 'layer-trends.dat' index 10 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle, \
     'layer-trends.dat' index 10 using 1:($4==1?$2:NaN) with points pointsize 0.9 pointtype 7 linecolor '#ffffff' notitle

reset
unset title
set title '(i)'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
unset key
set xlabel 'end diameter d′ (mm)'
set ylabel 'order of the layers'
set key font ',11' spacing 1.0
set yrange [0:*]
set offsets graph 0.08, graph 0.08, graph 0.1, 0
set xrange [0.38:0.62]
plot 'layer-trends.dat' index 11 using 1:2 with linespoints linecolor '#355e8c' pointtype 7 pointsize 1.2 notitle
unset multiplot
