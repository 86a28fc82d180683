# ms against triangles, one panel for each detector, spheres: gnuplot -e "csv='raster.csv'; svg='raster.svg'" raster.gp
set datafile separator ","
set datafile missing NaN
set terminal svg size 1200,420 font "sans,12" background "white"
set output svg
set logscale xy
set xlabel "triangles"
set ylabel "ms a frame (minimum)"
set format x "10^{%T}"
set grid
set key bottom right
sizes = system("grep -v '^#' '".csv."' | tail -n +2 | cut -d , -f 3 | sort -nu")
embree = int(system("grep -c embree_min_ms '".csv."' || true"))
only(size, ms) = (strcol("shape") eq "sphere" && column("detector") == size) ? ms : NaN
set multiplot layout 1,words(sizes)
do for [size in sizes] {
    set title size." x ".size." pixels"
    if (embree) {
        plot csv using "triangles":(only(size, column("embree_min_ms"))) with linespoints lw 2 title "Embree 3", \
             csv using "triangles":(only(size, column("plain_c_min_ms"))) with linespoints lw 2 title "plain C, OpenMP", \
             csv using "triangles":(only(size, column("library_min_ms"))) with linespoints lw 2 title "library"
    } else {
        plot csv using "triangles":(only(size, column("plain_c_min_ms"))) with linespoints lw 2 title "plain C, OpenMP", \
             csv using "triangles":(only(size, column("library_min_ms"))) with linespoints lw 2 title "library"
    }
}
unset multiplot
