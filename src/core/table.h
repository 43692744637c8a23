#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// Named columns of numbers of equal length, as in a CSV file. NaN: no value.
class Table {
 public:
  /// `source` is the file name in messages. Throws Error(Errc::input) if the columns differ in length, if the
  /// numbers of names and columns differ, or if a name is empty or used twice.
  Table(std::string source, std::vector<std::string> names, std::vector<std::vector<double>> columns,
        bool last_line_cut = false, std::size_t header_line = 1);
  /// `lines`: the line of each row in the file.
  Table(std::string source, std::vector<std::string> names, std::vector<std::vector<double>> columns,
        std::vector<std::size_t> lines);

  /// Number of rows.
  std::size_t size() const noexcept { return columns_.empty() ? 0 : columns_.front().size(); }
  const std::vector<std::string>& names() const noexcept { return names_; }
  bool has(std::string_view name) const noexcept;

  /// The size() values of one column. Throws Error(Errc::input) with the file and its columns.
  std::span<const double> column(std::string_view name) const;
  /// The same, or an empty span if the column does not exist.
  std::span<const double> find(std::string_view name) const noexcept;

  /// True if the last line of the file was incomplete, as after a power failure; it is not among the rows.
  bool last_line_cut() const noexcept { return last_line_cut_; }
  const std::string& source() const noexcept { return source_; }
  /// `file:line` of a row (0-based), for messages.
  std::string location(std::size_t row) const;

 private:
  std::string source_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  bool last_line_cut_;
  std::size_t header_line_;
  std::vector<std::size_t> lines_;  ///< empty: the rows follow the header
};

/// Treatment of a last line without a line end.
enum class LastLine {
  keep,  ///< it is read like the others
  drop   ///< it is left out, because its last number may be incomplete, and last_line_cut() is true
};

/// Reads a CSV file with one header line and numbers below it: comma separated, '.' as the decimal point, LF
/// or CRLF; lines above the header that start with '#' are comments. An empty field and `nan` are NaN;
/// infinite values are rejected. Throws Error(Errc::input, "file:line", reason) for a missing or empty file,
/// a directory, a field that is not a number, and a line with more or fewer fields than the header.
Table read_table(const std::filesystem::path& path, LastLine last_line = LastLine::keep);

/// A text as a field of a CSV file: in quotation marks if necessary (RFC 4180).
std::string csv_field(const std::string& text);

}  // namespace faba
