#include "core/table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"
#include "core/portable.h"

namespace faba {
namespace {

std::string_view trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

double number_in(std::string_view field, const std::string& file, std::size_t line,
                 const std::string& column) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [end, code] = portable::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc{} || end != field.data() + field.size() || std::isinf(value)) {
    throw Error(Errc::input, fmt::format("{}:{}", file, line),
                fmt::format("\"{}\" in column {} is not a number", field.substr(0, 40), column));
  }
  return value;
}

/// Removes the next line from `text` and returns it without its line end.
std::string_view next_line(std::string_view& text) {
  const auto end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

}  // namespace

Table::Table(std::string source, std::vector<std::string> names, std::vector<std::vector<double>> columns,
             bool last_line_cut, std::size_t header_line)
    : source_(std::move(source)),
      names_(std::move(names)),
      columns_(std::move(columns)),
      last_line_cut_(last_line_cut),
      header_line_(header_line) {
  if (names_.size() != columns_.size()) {
    throw Error(Errc::input, source_, fmt::format("{} names for {} columns", names_.size(), columns_.size()));
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto before = names_.begin() + std::ptrdiff_t(i);
    if (names_[i].empty()) {
      throw Error(Errc::input, source_ + ":1", fmt::format("column {} has no name", i + 1));
    }
    if (std::find(names_.begin(), before, names_[i]) != before) {
      throw Error(Errc::input, source_ + ":1", fmt::format("duplicate column {}", names_[i]));
    }
    if (columns_[i].size() != columns_.front().size()) {
      throw Error(Errc::input, source_,
                  fmt::format("columns {} and {} have different lengths", names_[i], names_[0]));
    }
  }
}

Table::Table(std::string source, std::vector<std::string> names, std::vector<std::vector<double>> columns,
             std::vector<std::size_t> lines)
    : Table(std::move(source), std::move(names), std::move(columns)) {
  lines_ = std::move(lines);
}

bool Table::has(std::string_view name) const noexcept {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

std::span<const double> Table::find(std::string_view name) const noexcept {
  const auto at = std::find(names_.begin(), names_.end(), name);
  if (at == names_.end()) return {};
  return columns_[std::size_t(at - names_.begin())];
}

std::span<const double> Table::column(std::string_view name) const {
  if (!has(name)) {
    std::string known;
    for (const std::string& other : names_) known += (known.empty() ? "" : ", ") + other;
    throw Error(Errc::input, source_ + ":1",
                fmt::format("column {} not found; the columns are {}", name, known));
  }
  return find(name);
}

std::string Table::location(std::size_t row) const {
  return fmt::format("{}:{}", source_, row < lines_.size() ? lines_[row] : header_line_ + row + 1);
}

Table read_table(const std::filesystem::path& path, LastLine last_line) {
  const std::string file = path.string();
  const std::string content = read_file(path);
  std::string_view text = content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark, written by spreadsheets
  if (trimmed(text).empty()) throw Error(Errc::input, file, "is empty");

  const auto last_end = text.rfind('\n');
  if (last_end == std::string_view::npos)
    throw Error(Errc::input, file + ":1", "the header line is incomplete");
  const bool cut = last_line == LastLine::drop && last_end + 1 != text.size();
  if (cut) text = text.substr(0, last_end + 1);

  std::size_t header = 1;
  for (; text.starts_with('#'); ++header) next_line(text);
  std::vector<std::string> names;
  for (const std::string_view name : split_fields(next_line(text))) names.emplace_back(name);
  std::vector<std::vector<double>> columns(names.size());
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.remove_suffix(1);
  for (std::size_t line = header + 1; !text.empty(); ++line) {
    const auto fields = split_fields(next_line(text));
    if (fields.size() != names.size()) {
      throw Error(
          Errc::input, fmt::format("{}:{}", file, line),
          fmt::format("{} fields, but the header has {}; separate columns with commas; decimals have a "
                      "point",
                      fields.size(), names.size()));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      columns[i].push_back(number_in(fields[i], file, line, names[i]));
    }
  }
  return Table(file, std::move(names), std::move(columns), cut, header);
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace faba
