# Set-up (the paper's Fig. 13), image and profile of three sources: gnuplot -e "work='PREFIX'; png='paper_images.png'" images.gp
set terminal pngcairo size 1500,1120 font "DejaVu Sans,13" background "white"
set output png
n = 301
pitch = 0.3
at(i) = (i - (n - 1) / 2.0) * pitch
array file[3] = ["point", "uncentred", "cube"]
array name[3] = ["point source", "uncentred point source, 6 mm aside", "cubic source of 5 mm"]
array colour[3] = ["#0072b2", "#d55e00", "#009e73"]
array aside[3] = [0, 6, 0]
array edge[3] = [0, 0, 5]
left(k) = 0.05 + 0.304 * (k - 1)
right(k) = left(k) + 0.268
set tics nomirror out
set multiplot

# The set-up from above, along the cylinder's axis; mm.
do for [k = 1:3] {
    unset object
    unset arrow
    unset label
    unset border
    unset tics
    unset xlabel
    unset ylabel
    set xrange [-117:122]
    set yrange [-70:58]
    set size ratio -1
    set lmargin at screen left(k) - 0.022
    set rmargin at screen right(k) + 0.022
    set bmargin at screen 0.73
    set tmargin at screen 0.965
    set title name[k] font "DejaVu Sans,15" offset 0,-0.4
    set object 1 rectangle from -15,-15 to 15,15 fillcolor rgb "#f6d8c8" fillstyle solid border lc rgb "#b08070"
    set object 2 circle at 0,0 size 10 fillcolor rgb "#fffbe8" fillstyle solid border lc rgb "#807050"
    set object 3 rectangle from 100,-45.15 to 103,45.15 fillcolor rgb "#404040" fillstyle solid noborder
    # The rays that touch the object; through its front corners the shadow is widest.
    hit(y) = aside[k] + (y - aside[k]) * 200 / 85.0
    set arrow 1 from -100,aside[k] to 100,hit(15) nohead lc rgb colour[k] lw 1.2 dt 2
    set arrow 2 from -100,aside[k] to 100,hit(-15) nohead lc rgb colour[k] lw 1.2 dt 2
    set arrow 3 from -112,0 to 99,0 nohead lc rgb "#909090" lw 0.8 dt 4
    if (edge[k] > 0) {
        set object 4 rectangle from -100 - edge[k] / 2.0,-edge[k] / 2.0 to -100 + edge[k] / 2.0,edge[k] / 2.0 fillcolor rgb colour[k] fillstyle solid noborder front
    } else {
        set object 4 circle at -100,aside[k] size 2 fillcolor rgb colour[k] fillstyle solid noborder front
    }
    set arrow 4 from -100,-64 to 0,-64 heads size 3,20 lc rgb "#606060"
    set arrow 5 from 0,-64 to 100,-64 heads size 3,20 lc rgb "#606060"
    set arrow 6 from 108,-45.15 to 108,45.15 heads size 3,20 lc rgb "#606060"
    set label 1 "100 mm" at -50,-58 center font ",11"
    set label 2 "100 mm" at 50,-58 center font ",11"
    set label 3 "301 × 0.3 mm" at 115,0 center rotate by 90 font ",11"
    set label 4 "source" at -90,14 center font ",11" textcolor rgb colour[k]
    set label 5 "cube, 30 mm" at 0,36 center font ",11" textcolor rgb "#905040"
    set label 6 "cylinder, 20 mm across" at 0,-40 center font ",11" textcolor rgb "#706030"
    set label 7 "detector" at 95,52 center font ",11"
    set arrow 7 from -112,32 to -112,50 size 3,20 lc rgb "#606060"
    set arrow 8 from -112,32 to -94,32 size 3,20 lc rgb "#606060"
    set label 8 "y" at -106,48 center font ",11" textcolor rgb "#606060"
    set label 9 "x" at -89,33 center font ",11" textcolor rgb "#606060"
    plot NaN notitle
}

unset object
unset arrow
unset label
set border 15 lc rgb "#404040"
set size ratio 1
set xrange [at(-0.5):at(n - 0.5)]
set yrange [at(-0.5):at(n - 0.5)]
set tics nomirror out scale 0.6
set xtics nomirror -40,20,40 offset 0,0.4
set palette gray
set cbrange [0.3:1]
unset title
do for [k = 1:3] {
    set lmargin at screen left(k)
    set rmargin at screen right(k)
    set bmargin at screen 0.345
    set tmargin at screen 0.705
    set xlabel "y, mm" offset 0,0.8
    if (k == 1) { set ylabel "z, mm" offset 1.5,0; set ytics nomirror -40,20,40 } else { unset ylabel; set ytics nomirror -40,20,40 format "" }
    if (k == 3) {
        set colorbox user origin right(3) + 0.008,0.345 size 0.01,0.36
        set cblabel "I/I_0" offset -0.5,0
        set cbtics nomirror 0.3,0.1,1 format "%.1f"
    } else {
        unset colorbox
    }
    set arrow 1 from at(-0.5),0 to at(n - 0.5),0 nohead lc rgb colour[k] lw 1 dt 3 front
    plot sprintf("%s%s.raw", work, file[k]) binary array=(n,n) dx=pitch dy=pitch origin=(at(0),at(0)) format='%float' using 1 with image notitle
}

unset arrow
unset colorbox
set size noratio
set datafile separator ","
set format y "%g"
set lmargin at screen left(1)
set rmargin at screen right(3)
set bmargin at screen 0.06
set tmargin at screen 0.28
set yrange [0.33:1.04]
set ytics nomirror 0.4,0.2,1
set xtics nomirror -40,10,40
set grid lc rgb "#dddddd"
set ylabel "I/I_0" offset 1.5,0
set xlabel "y, mm, along the dotted row"
set key center top spacing 1.3 samplen 2
plot for [k = 1:3] sprintf("%sprofiles.csv", work) using (at($1)):(column(k + 1)) with lines lw 2.2 lc rgb colour[k] title name[k]
unset multiplot
