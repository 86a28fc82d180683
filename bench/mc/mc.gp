# Both images, the relative error and the profiles: gnuplot -e "work='PREFIX'; png='mc.png'; n=301; pitch=0.3" mc.gp
set terminal pngcairo size 1300,1000 font "sans,12" background "white"
set output png
set multiplot layout 2,2
at(i) = (i - (n - 1) / 2.0) * pitch
image(name) = sprintf("%s%s.raw", work, name)
set size ratio 1
set xlabel "mm"
set ylabel "mm"
set xrange [at(-0.5):at(n - 0.5)]
set yrange [at(-0.5):at(n - 0.5)]
set palette gray
set cbrange [0:1]
set title "I/I0, library"
plot image("ours") binary array=(n,n) dx=pitch dy=pitch origin=(at(0),at(0)) format='%float' using 1 with image notitle
set title "I/I0, Monte Carlo, primary and scatter"
plot image("total") binary array=(n,n) dx=pitch dy=pitch origin=(at(0),at(0)) format='%float' using 1 with image notitle
set palette defined (-8 "dark-blue", 0 "white", 8 "dark-red")
set cbrange [-8:8]
set title "relative error, %"
plot image("error") binary array=(n,n) dx=pitch dy=pitch origin=(at(0),at(0)) format='%float' using 1 with image notitle
set size noratio
set yrange [0:1.1]
set ylabel "I/I0"
set title "profiles through the middle"
set datafile separator ","
set key center bottom
profiles = sprintf("%sprofiles.csv", work)
plot profiles using (at($1)):2 with lines lw 2 title "row, library", \
     profiles using (at($1)):3 with points pt 7 ps 0.3 title "row, Monte Carlo", \
     profiles using (at($1)):4 with lines lw 2 title "column, library", \
     profiles using (at($1)):5 with points pt 7 ps 0.3 title "column, Monte Carlo"
unset multiplot
