#pragma once
// Rows of real numbers from CSV text.

#include <cstddef>
#include <istream>
#include <limits>
#include <string>
#include <vector>

namespace strainfinger {

/// Reads rows of `columns` finite numbers, separated by commas (blanks around them are allowed). A first row
/// that doesn't begin with a number is a header; blank lines and lines that begin with # are passed over.
class NumberRowReader {
 public:
  /// What numbers may be: at most `most` in size; `hint` says what a larger one may have been meant to be.
  struct Limit {
    double most;
    std::string hint;
  };

  /// `name` stands for the stream in messages ("stdin").
  NumberRowReader(std::istream& stream, std::string name, std::size_t columns,
                  Limit limit = {std::numeric_limits<double>::max(), ""});

  /// The next row; false at the end. Throws Failure(kFailure) with name:line:column, what is wrong and what
  /// would be right, for a field that is no finite number or beyond the limit and for a
  /// row of another length.
  bool next(std::vector<double>& row);

 private:
  void parse(const std::string& line, std::vector<double>& row) const;
  [[noreturn]] void fail(std::size_t column, const std::string& what) const;

  std::istream& stream_;
  std::string name_;
  std::size_t columns_;
  Limit limit_;
  std::size_t line_ = 0;
  bool mayBeHeader_ = true;
};

}  // namespace strainfinger
