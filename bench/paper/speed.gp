# Images per second against triangles, a box for each way and size: gnuplot -e "csv='paper.csv'; png='paper_speed.png'" speed.gp
# Boxes: quartiles and median; whiskers: all values
set terminal pngcairo size 1500,700 font "DejaVu Sans,13" background "white"
set output png
set datafile separator ","
set datafile commentschars "#"
array ways[7] = ["half; closed", "single; closed", "double; closed", "single; liver open; none", \
                 "single; liver open; neighbours", "single; liver open; exact", "single; all open; neighbours"]
array label[7] = ["half", "single", "double", "no correction", "mean of neighbours", "cast anew, exact", \
                  "all meshes open, mean of neighbours"]
array colour[7] = ["#d55e00", "#0072b2", "#009e73", "#999999", "#cc79a7", "#56b4e9", "#806000"]
# The sizes of the run, rising, as its first way gives them: separated by spaces.
sizes = ""
stats csv using (strcol(1) eq "images" && strcol(2) eq ways[2] && $4 == 1 ? (sizes = sizes . " " . strcol(3), $3) : NaN) nooutput
count = words(sizes)
rate(w, i) = strcol(1) eq "images" && strcol(2) eq ways[w] && strcol(3) eq word(sizes, i) ? $5 : NaN
commas(text) = strlen(text) > 3 ? text[1:strlen(text) - 3] . "," . text[strlen(text) - 2:*] : text

set style data boxplot
set style boxplot fraction 1.0 nooutliers
set style fill solid 0.35 border
set boxwidth 0.1 absolute
set border 3 lc rgb "#404040"
set tics nomirror out
set logscale y
set yrange [0.5:3000]
set ytics (0.5, 1, 3, 10, 30, 100, 300, 1000)
set grid y lc rgb "#dddddd"
set xrange [0.45:count + 0.55]
set xtics ("" 0)
do for [i = 1:count] { set xtics add (commas(word(sizes, i)) i) }
set xlabel "triangles"
set key top right spacing 1.2 samplen 1.5 width -2
shift(j, m) = (j - (m + 1) / 2.0) * 0.16
# The paper's images per second, with correction, beside the size that is nearest to its 41,710 triangles.
set multiplot layout 1,2 margins 0.06,0.985,0.11,0.91 spacing 0.05,0
off(i) = abs(word(sizes, i) - 41710)
at42 = 1
do for [i = 2:count] { if (off(i) < off(at42)) { at42 = i } }
if (off(at42) < 5000) {
    set object 1 rectangle from at42 - 0.42,13 to at42 + 0.42,101 fillcolor rgb "#fff2b0" fillstyle solid noborder behind
}
paper = "the paper, 41,710 triangles, with correction"
set title "closed meshes: no bad pixel, nothing to correct"
set ylabel "images per second" offset 1.5,0
plot for [j = 1:3] for [i = 1:count] csv using (i + shift(j, 3)):(rate(j, i)) lc rgb colour[j] lw 1.5 notitle, \
     for [j = 1:3] NaN with boxes lc rgb colour[j] title label[j], \
     NaN with boxes fillstyle solid noborder lc rgb "#fff2b0" title paper
set title "single precision, the liver (or all meshes) with holes"
unset ylabel
plot for [j = 4:7] for [i = 1:count] csv using (i + shift(j - 3, 4)):(rate(j, i)) lc rgb colour[j] lw 1.5 notitle, \
     for [j = 4:7] NaN with boxes lc rgb colour[j] title label[j], \
     NaN with boxes fillstyle solid noborder lc rgb "#fff2b0" title paper
unset multiplot
