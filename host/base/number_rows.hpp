#pragma once
// Rows of real numbers from CSV text.

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace strainfinger {

/// Reads rows of `columns` finite numbers, separated by commas (blanks around them are allowed). A first row
/// that doesn't begin with a number is a header; blank lines and lines that begin with # are passed over.
class NumberRowReader {
 public:
  /// `name` stands for the stream in messages ("stdin").
  NumberRowReader(std::istream& stream, std::string name, std::size_t columns);

  /// The next row; false at the end. Throws Failure(kFailure) with name:line:column, what is wrong and what
  /// would be right, for a field that is no finite number and for a row of another length.
  bool next(std::vector<double>& row);

 private:
  void parse(const std::string& line, std::vector<double>& row) const;
  [[noreturn]] void fail(std::size_t column, const std::string& what) const;

  std::istream& stream_;
  std::string name_;
  std::size_t columns_;
  std::size_t line_ = 0;
  bool mayBeHeader_ = true;
};

}  // namespace strainfinger
