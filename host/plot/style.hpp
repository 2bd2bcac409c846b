#pragma once
// How all pictures look.

namespace strainfinger::plot {

/// Begins a script. Okabe & Ito's colours, told apart by the colour-blind too; axes left and below, a faint
/// grid, the key above a plot at its right.
inline constexpr const char* kStyle = R"(
black = '#000000'; blue = '#0072B2'; vermilion = '#D55E00'; orange = '#E69F00'; green = '#009E73'
lightBlue = '#8CC5E3'; faint = '#777777'
set encoding utf8
set border 3 linecolor '#555555'
set tics nomirror out scale 0.6 textcolor '#333333'
set grid xtics ytics linecolor '#E6E6E6' linetype 1
set key at graph 1,1.01 bottom right horizontal samplen 2 textcolor '#333333'; set tmargin 2.5
)";

}  // namespace strainfinger::plot
