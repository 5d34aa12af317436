# gnuplot fig05-g2.gp  draws fig05-g2.png from fig05-g2.dat
set terminal pngcairo size 1440,610 enhanced font 'DejaVu Sans,14' linewidth 1.6 background '#ffffff'
set output 'fig05-g2.png'
set multiplot layout 1,2 title "Orientational correlation" font ',17'

reset
unset title
set title '(a) shortest rods, ℓ = 2.5 mm'
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
plot 'fig05-g2.dat' index 0 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig05-g2.dat' index 1 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig05-g2.dat' index 2 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig05-g2.dat' index 3 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig05-g2.dat' index 4 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig05-g2.dat' index 5 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig05-g2.dat' index 6 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig05-g2.dat' index 7 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig05-g2.dat' index 8 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'

reset
unset title
set title '(b) longest rods, ℓ = 4.5 mm'
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
plot 'fig05-g2.dat' index 9 using 1:2 with lines linecolor '#440154' linewidth 1 title 'φ = 0.45', \
     'fig05-g2.dat' index 10 using 1:2 with lines linecolor '#472674' linewidth 1 title 'φ = 0.5', \
     'fig05-g2.dat' index 11 using 1:2 with lines linecolor '#3f4686' linewidth 1 title 'φ = 0.55', \
     'fig05-g2.dat' index 12 using 1:2 with lines linecolor '#33638d' linewidth 1 title 'φ = 0.6', \
     'fig05-g2.dat' index 13 using 1:2 with lines linecolor '#287d8e' linewidth 1 title 'φ = 0.65', \
     'fig05-g2.dat' index 14 using 1:2 with lines linecolor '#23978a' linewidth 1 title 'φ = 0.7', \
     'fig05-g2.dat' index 15 using 1:2 with lines linecolor '#2cb07e' linewidth 1 title 'φ = 0.75', \
     'fig05-g2.dat' index 16 using 1:2 with lines linecolor '#59c764' linewidth 1 title 'φ = 0.8', \
     'fig05-g2.dat' index 17 using 1:2 with lines linecolor '#9ad83c' linewidth 1 title 'φ = 0.85'
unset multiplot
