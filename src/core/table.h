#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// Columns of numbers with names, of equal length, as a CSV file holds them. NaN stands for "nothing there".
class Table {
 public:
  /// `source` is the file name that messages show. Throws Error(Errc::input) when the columns differ in
  /// length, when there is not one name per column, or when a name is empty or used twice.
  Table(std::string source, std::vector<std::string> names, std::vector<std::vector<double>> columns,
        bool last_line_cut = false, std::size_t header_line = 1);

  /// Number of rows.
  std::size_t size() const noexcept { return columns_.empty() ? 0 : columns_.front().size(); }
  const std::vector<std::string>& names() const noexcept { return names_; }
  bool has(std::string_view name) const noexcept;

  /// The values of one column, size() of them. Throws Error(Errc::input) naming the file and the columns it
  /// does have.
  std::span<const double> column(std::string_view name) const;
  /// The same, or an empty span when there is no such column.
  std::span<const double> find(std::string_view name) const noexcept;

  /// True when the file ended in the middle of a line, as after a power cut; that line is not among the rows.
  bool last_line_cut() const noexcept { return last_line_cut_; }
  const std::string& source() const noexcept { return source_; }
  /// `file:line` of a row (0-based), for messages.
  std::string place(std::size_t row) const;

 private:
  std::string source_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  bool last_line_cut_;
  std::size_t header_line_;
};

/// What becomes of a last line without its line end.
enum class LastLine {
  keep,  ///< it is a line like the others
  drop   ///< its last number may be half a number: it is left out, and last_line_cut() says so
};

/// Reads a CSV file with one header line and numbers below it: comma separated, '.' as the decimal point, LF
/// or CRLF; lines above it that begin with '#' are comments. An empty field and `nan` are NaN; an infinite
/// value is refused. Throws Error(Errc::input, "file:line", reason) for a missing or empty file, a directory,
/// a field that is not a number, and a line with more or fewer fields than the header.
Table read_table(const std::filesystem::path& path, LastLine last_line = LastLine::keep);

}  // namespace faba
