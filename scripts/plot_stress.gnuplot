# Draws the error of every method where numbers are put under stress, a panel per kind of stress.
#
#   gnuplot -c plot_stress.gnuplot CSV OUTPUT        OUTPUT ends in .svg or .png; CSV is what error_under_stress prints
#
# Colours that colour-blind people can tell apart (Okabe and Ito).
csv = ARG1
output_file = ARG2

if (output_file[strlen(output_file)-3:] eq ".svg") {
  set terminal svg size 1180,820 enhanced font "DejaVu Sans,13" background "#ffffff"
} else {
  set terminal pngcairo size 2360,1640 enhanced font "DejaVu Sans,13" fontscale 2 linewidth 2 background "#ffffff"
}
set output output_file
set datafile separator ","

set border 3 linecolor "#888888"
set tics nomirror textcolor "#444444" font ",11"
set grid linecolor "#e4e4e4" linetype 1
set style line 1 linecolor "#d55e00" linewidth 2
set style line 2 linecolor "#e69f00" linewidth 2
set style line 3 linecolor "#009e73" linewidth 2
set style line 4 linecolor "#0072b2" linewidth 2
set style line 5 linecolor "#56b4e9" linewidth 2
set style line 6 linecolor "#000000" linewidth 2
set style line 7 linecolor "#cc79a7" linewidth 2 dashtype (9,5)

methods = "fast improved fast_surface exact exact_surface hierarchical float32_in_world"
titles = "'fast' 'improved' 'fast\\_surface' 'exact' 'exact\\_surface' 'hierarchical' 'single precision, in the world'"
rows(sweep, m) = sprintf("< awk -F, '$1 == \"%s\" && $3 == \"%s\"' %s", sweep, word(methods, m), csv)
# A double knows no error of less than this beside the whole; and 0 has no logarithm.
visible(error) = error < 1.2e-17 ? 1.2e-17 : error > 1e9 ? 1e9 : error

set multiplot layout 2,3 title "Error of the force, relative to the whole displacement" font ",15" \
  textcolor "#222222" margins 0.065,0.985,0.085,0.9 spacing 0.05,0.15
set logscale xy
set format xy "10^{%T}"
set yrange [1e-17:1e9]
set ytics 1000
set key off

set xtics 1e3
set title "tilt of a box of flat faces" textcolor "#222222"
set xlabel "rad" textcolor "#444444" offset 0,0.4
plot for [m=1:7] rows("tilt", m) using 2:(visible($4)) with lines linestyle m
set title "level and position, far up"
set xlabel "m"
plot for [m=1:7] rows("level", m) using 2:(visible($4)) with lines linestyle m
set title "mesh far from its own origin"
plot for [m=1:7] rows("origin", m) using 2:(visible($4)) with lines linestyle m
set title "size of the body"
plot for [m=1:7] rows("scale", m) using 2:(visible($4)) with lines linestyle m
set title "share that is wet; dotted: all of it missed"
set xlabel "of the whole displacement"
set yrange [1e-27:1e1]
plot for [m=1:7] rows("wet_share", m) using 2:($4 < 1.2e-27 ? 1.2e-27 : $4) with lines linestyle m, \
     rows("wet_share", 1) using 2:2 with lines linecolor "#999999" linewidth 1 dashtype 3

# The sixth panel holds the names.
unset border
unset tics
unset grid
unset title
unset xlabel
unset logscale
set xrange [0:1]
set yrange [0:1]
set key at graph -0.05,0.85 left top reverse Left samplen 3 spacing 1.6 textcolor "#222222"
plot for [m=1:7] 2 with lines linestyle m title word(titles, m)
unset multiplot
