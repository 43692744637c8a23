#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// What was recorded once per camera frame: named columns of equal length, one row per frame, in the order
/// written. The unit is the end of a column's name (`_px` picture pixels with y down, `_s` seconds, `_ut`
/// microtesla in the world frame with y up, `_a` ampere). NaN stands for "nothing there", for instance a
/// setpoint when there is no target.
///
/// Columns of a run's `series.csv`:
/// `frame,t_s,centroid_x_px,centroid_y_px,sigma_x_px,sigma_y_px,rms_radius_px, distance_px`, and as far as
/// the run has them `visible_count,responding_count,estimate_x_px,estimate_y_px,
/// setpoint_x_px,setpoint_y_px,field_x_ut,field_y_ut,current_0_a,current_1_a,...,limited`.
class Series {
 public:
  /// `source` is the file name that messages show. Throws Error(Errc::input) when the columns differ in
  /// length, when there is not one name per column, or when a name is empty or used twice.
  Series(std::string source, std::vector<std::string> names, std::vector<std::vector<double>> columns,
         bool last_line_cut = false);

  /// Number of rows (frames); zero for a run stopped before its first frame.
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
  /// `file:line` of a row (0-based), for messages. The header is line 1.
  std::string place(std::size_t row) const;

 private:
  std::string source_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  bool last_line_cut_;
};

/// Reads a CSV file with one header line and numbers below it: comma separated, '.' as the decimal point, LF
/// or CRLF. An empty field and `nan` are NaN; an infinite value is refused. A last line without its line end
/// is dropped, because its last number may be half a number, and last_line_cut() says so. Throws
/// Error(Errc::input, "file:line", reason) for a missing or empty file, a directory, a field that is not a
/// number, and a line with more or fewer fields than the header.
Series read_series(const std::filesystem::path& path);

}  // namespace faba
