#pragma once
// Rows of real numbers from CSV text.

#include <cstddef>
#include <istream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strainfinger {

/// Reads rows of `columns` finite numbers, separated by commas (blanks around them are allowed). A first row
/// of names is a header: they begin with a letter and are no word for a missing number (NA, nan, null ..),
/// and are as many as the columns. Names and texts may be quoted, with commas in them (RFC 4180). Blank lines
/// and lines that begin with # are passed over, as are a byte order mark and the header where it is repeated
/// (with its mark), as in files that were put together. A last line that was cut off, as by a full disk, is
/// told on stderr and left out. A cut is not noticed inside a last number of which a plausible one is left,
/// as 1.2 of 1.25, or of 1.2e-5 where there is no limit.
class NumberRowReader {
 public:
  /// What may be there: numbers of at most `most` in size (`hint` says what a larger one may have been meant
  /// to be); as a header, if there is one, just `header` (blanks apart), or one that has these `columns`
  /// among others in any order, or any where both are empty.
  struct Limit {
    double most = std::numeric_limits<double>::max();
    std::string hint = {};
    std::string header = {};
    std::vector<std::string> columns = {};
    bool mayBeEmpty = false;  ///< an empty field is a NaN: not known
    /// Names that begin so and go on with a number are no other columns: there are more of `columns` than
    /// are wanted. `familyHint` says why that is wrong. Empty: there are no such names.
    std::string family = {};
    std::string familyHint = {};
  };

  /// `name` stands for the stream in messages ("stdin").
  NumberRowReader(std::istream& stream, std::string name, std::size_t columns, Limit limit);
  NumberRowReader(std::istream& stream, std::string name, std::size_t columns)
      : NumberRowReader(stream, std::move(name), columns, Limit()) {}

  /// The next row; false at the end. Throws Failure(kFailure) with name:line:column, what is wrong and what
  /// would be right, for a field that is no finite number or beyond the limit, for a
  /// row of another length, for another header, for a line longer than LineReader hands out and for a
  /// compressed file; with the system's reason where the stream cannot be read.
  bool next(std::vector<double>& row);

  /// The last row was cut off, and left out.
  bool isCut() const { return isCut_; }

  /// name:line of the last row, for messages about what it says.
  std::string place() const;

  /// The columns beside Limit::columns: their names, known with the first row, and the last row's texts.
  const std::vector<std::string>& otherNames() const { return otherNames_; }
  const std::vector<std::string>& others() const { return others_; }

 private:
  bool isCut(const std::string& line) const;
  bool isHeaderAgain(std::string_view line) const;
  bool readLine(std::string& line);
  void requireReadable() const;
  void takeHeader(const std::string& line);
  void chooseColumns(const std::vector<std::string>& names);
  void requireNoMore() const;
  void parse(const std::string& line, std::vector<double>& row);
  double numberOf(const std::string& field, std::size_t column) const;
  void requireCommas(const std::vector<std::string_view>& fields, const std::string& line) const;
  [[noreturn]] void fail(std::size_t column, const std::string& what) const;

  std::istream& stream_;
  std::string name_;
  std::size_t columns_;
  Limit limit_;
  std::vector<char> buffer_;  ///< of a line and a NUL
  std::size_t line_ = 0;
  bool mayBeHeader_ = true;
  bool isCut_ = false;
  std::vector<std::string> header_;  ///< its names; empty: there is none
  std::vector<std::size_t> places_;  ///< in the row, of the header's columns; empty: as they are
  std::vector<std::string> otherNames_;
  std::vector<std::string> others_;
};

}  // namespace strainfinger
