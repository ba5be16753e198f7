# Draws the paper's figure 4: force over height, and the error's size, for a cube and a sphere.
#
#   gnuplot -c plot_figure4.gnuplot CSV OUTPUT        OUTPUT ends in .svg or .png; CSV is what paper_figure4 prints
csv = ARG1
output_file = ARG2

if (output_file[strlen(output_file)-3:] eq ".svg") {
  set terminal svg size 1080,860 enhanced font "DejaVu Sans,13" background "#ffffff"
} else {
  set terminal pngcairo size 2160,1720 enhanced font "DejaVu Sans,13" fontscale 2 linewidth 2 background "#ffffff"
}
set output output_file
set datafile separator ","
set datafile missing NaN

set border 3 linecolor "#888888"
set tics nomirror textcolor "#444444" font ",11"
set grid linecolor "#e4e4e4" linetype 1
set style line 1 linecolor "#b2473e" linewidth 2
set style line 2 linecolor "#d98e3c" linewidth 2
set style line 3 linecolor "#4a8c5c" linewidth 2
set style line 4 linecolor "#3c78b4" linewidth 2
set style line 5 linecolor "#7b5aa6" linewidth 2
set style line 6 linecolor "#222222" linewidth 2

methods = "fast improved fast_surface exact exact_surface hierarchical"
rows(shape, triangles, m) = sprintf("< awk -F, '$1 == \"%s\" && $2 == %d && $3 == \"%s\"' %s", shape, triangles, word(methods, m), csv)
size_of(x) = abs(x) < 1e-17 ? 1e-17 : abs(x)

set multiplot layout 2,2 title "Buoyant force on a body lowered into the water, {/:Italic ρg} = 1" font ",15" \
  textcolor "#222222" margins 0.085,0.975,0.155,0.9 spacing 0.085,0.1
set key off

set ylabel "force" textcolor "#444444"
set title "cube, 1,200 triangles" textcolor "#222222"
plot for [m=1:6] rows("cube", 1200, m) using 4:5 with lines linestyle m title word(methods, m)
set title "sphere, 5,000 triangles"
unset ylabel
plot for [m=1:6] rows("sphere", 5000, m) using 4:5 with lines linestyle m title word(methods, m)

set logscale y
set format y "10^{%T}"
set yrange [1e-17:1]
set xlabel "height of the centre over the water" textcolor "#444444"
set ylabel "error relative to the whole" textcolor "#444444"
set title "solid: 1,200 triangles; dashed: 120,000"
set key noenhanced at screen 0.5,0.045 center horizontal maxrows 1 samplen 2.5 textcolor "#222222" noautotitle
plot for [m=1:6] rows("cube", 1200, m) using 4:(size_of(column(7))) with lines linestyle m title word(methods, m), \
     for [m=1:6] rows("cube", 120000, m) using 4:(size_of(column(7))) with lines linestyle m dashtype 2
set key off
unset ylabel
set title "solid: 5,000 triangles; dashed: 80,000"
plot for [m=1:6] rows("sphere", 5000, m) using 4:(size_of(column(7))) with lines linestyle m, \
     for [m=1:6] rows("sphere", 80000, m) using 4:(size_of(column(7))) with lines linestyle m dashtype 2
unset multiplot
