# gnuplot fig04-correlations.gp  draws fig04-correlations.png from fig04-correlations.dat
set terminal pngcairo size 1440,1170 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig04-correlations.png'
set multiplot layout 2,2 title "Correlations in space" font ',17'

reset
unset title
set title '(a) ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance r (mm)'
set ylabel 'G_2(r) = ⟨cos 2({/Symbol q}_i − {/Symbol q}_j)⟩'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
plot 'fig04-correlations.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig04-correlations.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig04-correlations.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig04-correlations.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig04-correlations.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig04-correlations.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig04-correlations.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig04-correlations.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig04-correlations.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance r (mm)'
set ylabel 'G_2(r) = ⟨cos 2({/Symbol q}_i − {/Symbol q}_j)⟩'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 0 to graph 1, first 0 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
unset key
plot 'fig04-correlations.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig04-correlations.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig04-correlations.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig04-correlations.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig04-correlations.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig04-correlations.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig04-correlations.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig04-correlations.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig04-correlations.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(c) ℓ = 2.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance r (mm)'
set ylabel 'g(r)'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
plot 'fig04-correlations.dat' index 18 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig04-correlations.dat' index 19 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig04-correlations.dat' index 20 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig04-correlations.dat' index 21 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig04-correlations.dat' index 22 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig04-correlations.dat' index 23 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig04-correlations.dat' index 24 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig04-correlations.dat' index 25 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig04-correlations.dat' index 26 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(d) ℓ = 4.5 mm'
set border 3 linecolor '#333333'
set tics nomirror out textcolor '#333333'
set grid linetype 1 linecolor '#e2e2e2' linewidth 0.5
set key noenhanced reverse Left samplen 1.5 spacing 1.15 font ',15'
set key outside top center horizontal maxcols 5
set xlabel 'distance r (mm)'
set ylabel 'g(r)'
set key font ',11' spacing 1.0
set xrange [0:*]
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor '#999999' dashtype 2 back
set tmargin 4.4
unset key
plot 'fig04-correlations.dat' index 27 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig04-correlations.dat' index 28 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig04-correlations.dat' index 29 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig04-correlations.dat' index 30 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig04-correlations.dat' index 31 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig04-correlations.dat' index 32 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig04-correlations.dat' index 33 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig04-correlations.dat' index 34 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig04-correlations.dat' index 35 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'
unset multiplot
