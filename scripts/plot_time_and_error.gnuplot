# Draws time against error of every method on the rocks of growing size, both axes logarithmic.
#
#   gnuplot -c plot_time_and_error.gnuplot CSV OUTPUT      OUTPUT ends in .svg or .png; CSV is what scripts/bench --csv writes
#
# A line per method, a point per size of mesh; colours that colour-blind people can tell apart (Okabe and Ito), and a point
# shape and a label of its own for each method.
csv = ARG1
output_file = ARG2

if (output_file[strlen(output_file)-3:] eq ".svg") {
  set terminal svg size 1080,760 enhanced font "DejaVu Sans,13" background "#ffffff"
} else {
  set terminal pngcairo size 2160,1520 enhanced font "DejaVu Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
}
set output output_file
set datafile separator ","

set border 3 linecolor "#888888"
set tics nomirror textcolor "#444444" font ",11"
set grid linecolor "#e4e4e4" linetype 1
set key off
set logscale xy
set format x "%g"
set format y "10^{%T}"
set xrange [0.03:30000]
set yrange [1e-17:3]
set ytics 100
set xlabel "time of one query, µs (median of 100 poses from almost dry to almost submerged)" textcolor "#444444"
set ylabel "error of force, relative to the whole displacement (largest of the 100)" textcolor "#444444"
set label 1 "one line per method, one point per mesh, named by its triangles; dotted: reading its vertices and indices once" \
  at graph 0.5,1.025 center font ",12" textcolor "#444444"
set title "Time and error of every method on meshes of growing size: lower left is better" offset 0,1.1 font ",15" textcolor "#222222"
set lmargin 11
set rmargin 3
set bmargin 4
set tmargin 5

# Rows of the rock in its own order, poses far apart, on the first instruction set that stands in the file: the best.
rows(method, tolerance) = sprintf("< awk -F, '$1 == \"rock\" && $3 == \"%s\" && $4 + 0 == %s && $6 == \"independent\" && !seen[$2]++' %s | sort -t, -k2n", method, tolerance, csv)
us(ns) = ns / 1000
visible(x) = x < 1.2e-17 ? 1.2e-17 : x
# An underscore in enhanced text would lower what follows.
escaped(name) = strstrt(name, "_") > 0 ? name[:strstrt(name, "_")-1] . "\\\\_" . name[strstrt(name, "_")+1:] : name
# 5 k, 30 k, 298 k, 1 M
short(n) = n < 1e6 ? sprintf("%.0f k", n / 1e3) : sprintf("%.0f M", n / 1e6)

methods = "fast improved fast_surface exact exact_surface"
colors = "#d55e00 #e69f00 #009e73 #0072b2 #56b4e9"
points = "5 7 9 11 13"
tolerances = "0 1e-6 1e-4 1e-3 1e-2"
tolerance_points = "7 4 8 10 12"
last_row(method) = sprintf("%s | tail -n 1", rows(method, "0"))
# Named at its fastest point where it is at work: on small meshes a small tolerance leaves nothing out.
named_row(tolerance) = sprintf("%s | awk -F, '%s == 0 || $8 > 1e-12' | sort -t, -k7g | head -n 1", rows("hierarchical", tolerance), tolerance)
# Two lines of nearly equal error: the one is named above, the other below.
above(m) = word(methods, m) eq "exact" ? -0.9 : 0.9

plot rows("read", "0") using (us($7)):(1e-17):(0):(3) with vectors nohead linecolor "#999999" dashtype 3, \
     rows("read", "0") using (us($7)):(3e-14):("reading " . short($2)) with labels left rotate by 90 offset -0.7,0 font ",10" textcolor "#777777", \
     for [m=1:5] rows(word(methods, m), "0") using (us($7)):(visible($8)) with linespoints \
       linecolor rgb word(colors, m) linewidth 2 pointtype int(word(points, m)) pointsize 1.1, \
     for [t=1:5] rows("hierarchical", word(tolerances, t)) using (us($7)):(visible($8)) with linespoints \
       linecolor rgb (t == 1 ? "#000000" : "#aa4488") linewidth 2 pointtype int(word(tolerance_points, t)) pointsize 1.1, \
     for [m=1:5] last_row(word(methods, m)) using (us($7)):(visible($8)):(escaped(word(methods, m))) with labels center \
       offset 0,above(m) textcolor rgb word(colors, m), \
     for [t=1:5] named_row(word(tolerances, t)) using (us($7)):(visible($8)):(t == 1 ? "hierarchical" : "hierarchical, tolerance " . word(tolerances, t)) \
       with labels right offset -1,0 textcolor rgb (t == 1 ? "#000000" : "#aa4488"), \
     rows("hierarchical", "0") using (us($7)):(visible($8)):(short($2)) with labels center offset 0,-0.9 font ",10" textcolor "#444444", \
     rows("improved", "0") using (us($7)):(visible($8)):(short($2)) with labels center offset 0,-0.9 font ",10" textcolor "#444444"
