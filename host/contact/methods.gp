# The paper's method beside the spectral one. In the project's folder, with the program built by --preset host:
#     gnuplot host/contact/methods.gp      # writes host/contact/methods.png
program = 'build/host/strainfinger'
flat = ' contact --indenter flat --width-m 2e-3 --points 1601'
spectral = '< '.program.flat.' 2>/dev/null'
paper(cutoff) = '< '.program.flat.' --method paper --cutoff '.cutoff.' 2>/dev/null'
both(cutoff) = '< bash -c "paste -d, <('.program.flat.' --method paper --cutoff '.cutoff.') <('.program.flat.')" 2>/dev/null'
mm(angle_deg) = angle_deg * pi / 180 * 12.7
peak_kpa = 13.6862526
cutoffs = '1e-1 1e-2 1e-3 1e-4'

set terminal pngcairo size 1100,480 font ',11'
set output 'host/contact/methods.png'
set datafile separator ','
set border 3 linecolor '#555555'
set tics nomirror out scale 0.6 textcolor '#333333'
set grid linecolor '#E6E6E6' linetype 1
set key at graph 1,1.01 bottom right horizontal samplen 2 textcolor '#333333'
set linetype 1 linecolor '#0072B2' linewidth 1.6
set linetype 2 linecolor '#D55E00' linewidth 1.6
set linetype 3 linecolor '#E69F00' linewidth 1.6
set linetype 4 linecolor '#009E73' linewidth 1.6
set tmargin 2.5
set xlabel 'arc on the surface (mm)'
set xrange [0:2]
set multiplot layout 1,2

set ylabel 'pressure (kPa)'
set yrange [-4:18]
plot spectral using (mm($1)):($2 / 1e3) every ::1 with lines linewidth 3 linecolor '#000000' title 'spectral', \
     for [i = 1:4] paper(word(cutoffs, i)) using (mm($1)):($2 / 1e3) every ::1 \
       with lines linetype i title word(cutoffs, i)

set ylabel 'distance from the spectral answer, per peak pressure'
set yrange [1e-5:1]
set logscale y
set format y '10^{%T}'
plot for [i = 1:4] both(word(cutoffs, i)) using (mm($1)):(abs($2 - $6) / 1e3 / peak_kpa) every ::1 \
       with lines linetype i title word(cutoffs, i)
unset multiplot
