# Plots heave, roll, pitch and buoyant force over time for a run of one body. CSV is the output of buoyancy-client
# --csv.
#
#   gnuplot -c plot_run.gnuplot CSV OUTPUT TITLE UP        OUTPUT ends in .svg or .png; UP: up axis of the mesh, y or z
csv = ARG1
output_file = ARG2

if (output_file[strlen(output_file)-3:] eq ".svg") {
  set terminal svg size 960,900 enhanced font "DejaVu Sans,13" background "#ffffff"
} else {
  set terminal pngcairo size 1920,1800 enhanced font "DejaVu Sans,13" fontscale 2 linewidth 2 background "#ffffff"
}
set output output_file
set datafile separator ","

# Limit the number of points.
stats csv using (column("utime")) nooutput
stride = STATS_records > 2000 ? int(STATS_records / 2000) : 1

seconds(utime) = utime * 1e-6
degrees(angle) = angle * 180.0 / pi

# Angles are relative to the upright attitude. A mesh with up axis y is upright when it is rotated by 90 degrees about
# its x axis, so that this rotation is removed first.
c = ARG4 eq "y" ? sqrt(0.5) : 1.0
s = ARG4 eq "y" ? sqrt(0.5) : 0.0
roll_z_up(w, x, y, z)  = degrees(atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)))
pitch_z_up(w, x, y, z) = degrees(asin(2.0 * (w * y - z * x)))
roll(w, x, y, z)  = roll_z_up(w * c + x * s, x * c - w * s, y * c - z * s, z * c + y * s)
pitch(w, x, y, z) = pitch_z_up(w * c + x * s, x * c - w * s, y * c - z * s, z * c + y * s)

set border 3 linecolor "#888888"
set tics nomirror textcolor "#444444" font ",11"
set grid ytics linecolor "#dddddd" linetype 1
set key off
set xrange [0:*]
set style line 1 linecolor "#0b6e99" linewidth 1.8
set style line 2 linecolor "#c0562f" linewidth 1.8

set multiplot layout 3,1 title ARG3 font ",15" textcolor "#222222" margins 0.115,0.97,0.075,0.93 spacing 0,0.055
set format x ""

set ylabel "heave of the mesh's origin (m)" textcolor "#222222"
plot csv every stride using (seconds(column("utime"))):(column("pz")) with lines linestyle 1

set ylabel "angle from upright (degrees)"
set key top right Left reverse textcolor "#222222" samplen 2
plot csv every stride using (seconds(column("utime"))):(roll(column("qw"), column("qx"), column("qy"), column("qz"))) \
       with lines linestyle 1 title "roll", \
     csv every stride using (seconds(column("utime"))):(pitch(column("qw"), column("qx"), column("qy"), column("qz"))) \
       with lines linestyle 2 title "pitch"

set key off
set format x "%g"
set xlabel "time (s)" textcolor "#222222"
set ylabel "buoyant force (N)"
plot csv every stride using (seconds(column("utime"))):(column("fz")) with lines linestyle 1
unset multiplot
