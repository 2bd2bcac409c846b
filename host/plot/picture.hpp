#pragma once
// A picture as gnuplot draws it: a script and the data it reads, kept beside the picture so that anyone can
// redraw it.

#include <span>
#include <string>
#include <vector>

namespace strainfinger::plot {

/// Columns of numbers. A NaN is a gap in a curve; an empty row, a blank line in the file, also ends a filled
/// area.
struct DataFile {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< one number a column, or none
};

/// The script names a data file `data('name')` and a column that may have gaps `(gap(n))`; terminal, output
/// and size are draw()'s to say.
struct Picture {
  int width_px;
  int height_px;
  std::string script;
  std::vector<DataFile> data;
};

/// Draws `picture` to `path`, which ends in .svg or .png, and leaves the script beside it (path with .gp) and
/// the data (path's stem, a dash, the file's name, .csv). `cd` there and `gnuplot NAME.gp` draws it again.
/// Each file appears whole, and none unless gnuplot has drawn the picture; where one then can't be put in its
/// place (a folder has the name), others may be there. Throws Failure: kUsage for another ending, kFailure
/// when a file cannot be written, when gnuplot is not installed, or with what gnuplot complains about.
void draw(const Picture& picture, const std::string& path);

/// What draw() leaves beside a picture, without it: for who has no gnuplot yet. Throws as draw() does of
/// files.
void writeUndrawn(const Picture& picture, const std::string& path);

/// What draw() leaves beside a picture whose data files have these names, whatever was there.
std::vector<std::string> filesBeside(const std::string& path, std::span<const char* const> dataNames);

/// The picture as an <svg> element, to be put into a page: `name`, which no other picture of the page has,
/// begins all its ids. Throws as draw() does.
std::string svgElement(const Picture& picture, const std::string& name);

/// For who draws only after a long time: throws Failure(kFailure) where gnuplot is not installed.
void requireGnuplot();

/// The same, and throws Failure(kUsage) for a path that draw() would refuse.
void requirePicturePath(const std::string& path);

/// `text` as a string of a script, whatever is in it: gnuplot would run what stands behind a quotation mark
/// within.
std::string quoted(const std::string& text);

/// The script as draw() writes it, for a picture called `stem` + `ending`.
std::string completeScript(const Picture& picture, const std::string& stem, const std::string& ending);

}  // namespace strainfinger::plot
