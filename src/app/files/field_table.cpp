#include "app/files/field_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "field/field_columns.h"

namespace faba {
namespace {

constexpr const char* kPermitted =
    "x, y, z, rho, bx, by, bz, brho, b (the component along the only coordinate), or - for a column that is "
    "not "
    "used";

std::string_view trimmed(std::string_view s) {
  constexpr std::string_view kSpace = " \t\r";
  const auto first = s.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(kSpace) - first + 1);
}

// The fields of a line; spaces as separator may be repeated. Separators in quotation marks are part of a
// field.
std::vector<std::string> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    const bool separates = !quoted && (c == separator || (separator == ' ' && c == '\t'));
    if (c == '"')
      quoted = !quoted;
    else if (!separates)
      fields.back() += c;
    else if (separator != ' ' || !fields.back().empty())
      fields.emplace_back();
  }
  for (std::string& f : fields) f = trimmed(f);
  if (fields.size() > 1 && fields.back().empty() && separator == ' ') fields.pop_back();
  return fields;
}

// The names in a header with spaces between columns: "z (cm)  B (G)" has two.
std::vector<std::string> joined_units(const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const std::string& word : words) {
    if (!names.empty() && (word[0] == '(' || word[0] == '[' || word[0] == '/'))
      names.back() += " " + word;
    else
      names.push_back(word);
  }
  return names;
}

std::optional<double> number_in(std::string text, bool commas_are_decimal) {
  const auto minus = text.find("\xE2\x88\x92");  // the minus sign of typesetting
  if (minus != std::string::npos) text.replace(minus, 3, "-");
  if (text.starts_with('+')) text.erase(0, 1);
  if (commas_are_decimal && text.find('.') == std::string::npos) {
    const auto comma = text.find(',');
    if (comma != std::string::npos) text[comma] = '.';
  }
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// The lines of a file, divided into fields.
struct FieldLines {
  struct Line {
    std::size_t number;
    std::vector<std::string> fields;
  };
  std::string file;
  char separator = ',';
  std::vector<Line> lines;         // without comments and blank lines
  std::string comment;             // the last one above the first line
  std::size_t first_data = 0;      // the first line with a number
  std::vector<std::string> names;  // of the header; empty: none

  std::optional<double> number(const std::string& field) const { return number_in(field, separator != ','); }
  bool has_number(const Line& line) const {
    return std::any_of(line.fields.begin(), line.fields.end(),
                       [&](const std::string& f) { return number(f).has_value(); });
  }
  std::string location(std::size_t line) const { return fmt::format("{}:{}", file, lines[line].number); }
  /// Number of columns of the file.
  std::size_t width() const {
    return names.empty() ? lines[std::min(first_data, lines.size() - 1)].fields.size() : names.size();
  }
};

// Commas may be decimal: they separate columns only if a line has numbers between them.
char separator_of(std::string_view line) {
  if (line.find('\t') != std::string_view::npos) return '\t';
  if (line.find(';') != std::string_view::npos) return ';';
  const auto numbers = [](const std::vector<std::string>& fields, bool decimal) {
    return fields.size() > 1 && std::all_of(fields.begin(), fields.end(), [&](const std::string& f) {
             return f.empty() || number_in(f, decimal).has_value();
           });
  };
  if (line.find(',') != std::string_view::npos && !numbers(fields_of(line, ' '), true)) return ',';
  return line.find(' ') != std::string_view::npos && !numbers(fields_of(line, ','), false) ? ' ' : ',';
}

bool is_comment(std::string_view line) {
  return line[0] == '#' || line[0] == '%' || line[0] == '!' || line.starts_with("//");
}

// Whether the names are those of coordinates and components with units.
bool is_header(const std::vector<std::string>& names) {
  bool place = false, field = false;
  for (const std::string& name : names) {
    const auto c = field_column(name);
    if (c && c->unit) (c->is_field() ? field : place) = true;
  }
  return place && field;
}

std::vector<std::string> header_of(const FieldLines& f) {
  const auto names_in = [&](const std::vector<std::string>& fields) {
    return f.separator == ' ' ? joined_units(fields) : fields;
  };
  if (f.first_data == 0) {
    if (f.comment.empty()) return {};
    const std::string_view text =
        trimmed(std::string_view(f.comment).substr(f.comment.find_first_not_of("#%!/")));
    for (const char separator : {f.separator, ',', ';', '\t', ' '}) {
      const auto fields = fields_of(text, separator);
      auto names = separator == ' ' ? joined_units(fields) : fields;
      if (names.size() == f.lines[0].fields.size() && is_header(names)) return names;
    }
    return {};
  }
  std::vector<std::string> names = names_in(f.lines[f.first_data - 1].fields);
  const bool units = std::all_of(names.begin(), names.end(),
                                 [](const std::string& n) { return n.empty() || field_unit(n).has_value(); });
  if (!units || f.first_data < 2) return names;
  const std::vector<std::string> above = names_in(f.lines[f.first_data - 2].fields);
  if (above.size() != names.size()) return names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = fmt::format("{} ({})", above[i], names[i]);
  return names;
}

FieldLines lines_of(const std::filesystem::path& path) {
  FieldLines f;
  f.file = path.string();
  const std::string content = read_file(path);
  std::string_view text = content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.find('\0') != std::string_view::npos)
    throw Error(Errc::input, f.file, "is not a text file in UTF-8 or ASCII; export it as CSV");
  std::vector<std::pair<std::size_t, std::string_view>> rows;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const std::string_view bare = trimmed(line);
    if (bare.empty()) continue;
    if (!is_comment(bare))
      rows.emplace_back(number, line.substr(0, line.find_last_not_of(" \r") + 1));
    else if (rows.empty())
      f.comment = bare;
  }
  if (rows.empty()) throw Error(Errc::input, f.file, "is empty");
  f.separator = separator_of(rows[rows.size() / 2].second);
  for (const auto& [number, row] : rows)
    f.lines.push_back({number, fields_of(f.separator == ' ' ? trimmed(row) : row, f.separator)});
  while (f.first_data < f.lines.size() && !f.has_number(f.lines[f.first_data])) ++f.first_data;
  f.names = header_of(f);
  return f;
}

// Options that describe the file, for messages.
std::string example(std::size_t columns) {
  switch (columns) {
    case 3:
      return "--columns rho,z,bz --units cm,mT";
    case 4:
      return "--columns x,y,z,bz --units cm,mT";
    case 6:
      return "--columns x,y,z,bx,by,bz --units mm,mT";
    default: {
      std::string more;
      for (std::size_t i = 2; i < columns; ++i) more += ",-";
      return "--columns z,b" + more + " --units cm,G";
    }
  }
}

struct UsedColumn {
  std::size_t index;
  FieldColumn column;
};

std::vector<UsedColumn> stated_columns(const FieldLines& f, const std::vector<std::string>& columns) {
  std::vector<UsedColumn> used;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] == "-") continue;
    const auto c = field_column(columns[i]);
    if (!c)
      throw Error(Errc::usage, "--columns",
                  fmt::format("\"{}\" is not a column; it must be {}", columns[i], kPermitted));
    used.push_back({i, *c});
  }
  const std::size_t fields = f.lines[std::min(f.first_data, f.lines.size() - 1)].fields.size();
  if (columns.size() != fields)
    throw Error(Errc::usage, "--columns",
                fmt::format("names {} columns, but {} has {}; give one name for each, - for a column that is "
                            "not used",
                            columns.size(), f.file, fields));
  return used;
}

std::vector<UsedColumn> used_columns(const FieldLines& f, const FieldTableFormat& format) {
  if (!format.columns.empty()) return stated_columns(f, format.columns);
  if (f.names.empty())
    throw Error(
        Errc::input, f.file,
        fmt::format("has no header line with names and units; state them for its {} columns, such as {}",
                    f.width(), example(f.width())));
  std::vector<UsedColumn> used;
  for (std::size_t i = 0; i < f.names.size(); ++i)
    if (const auto c = field_column(f.names[i])) used.push_back({i, *c});
  const auto fields =
      std::count_if(used.begin(), used.end(), [](const UsedColumn& u) { return u.column.is_field(); });
  if (fields == 0 || std::size_t(fields) == used.size())
    throw Error(
        Errc::input, f.file,
        fmt::format("has no column for the {}, such as {}; its columns are {}; rename them, or give {}",
                    fields == 0 ? "field" : "position", fields == 0 ? "bz_mt" : "z_mm",
                    fmt::join(f.names, ", "), example(f.width())));
  return used;
}

void apply_units(std::vector<UsedColumn>& used, const std::vector<std::string>& units) {
  std::vector<FieldUnit> known;
  for (const std::string& text : units) {
    const auto unit = field_unit(text);
    if (!unit)
      throw Error(
          Errc::usage, "--units",
          fmt::format("\"{}\" is not a unit; it must be one of m, cm, mm, um, inch; T, mT, uT, nT, gauss",
                      text));
    known.push_back(*unit);
  }
  const bool pair = known.size() == 2 && known[0].of_field != known[1].of_field;
  if (!pair && known.size() != used.size())
    throw Error(
        Errc::usage, "--units",
        fmt::format("has {} units; give a unit for each of the {} used columns, or one of length and one "
                    "of field, such as cm,G",
                    known.size(), used.size()));
  for (std::size_t i = 0; i < used.size(); ++i) {
    FieldColumn& c = used[i].column;
    const std::size_t which = !pair ? i : known[0].of_field == c.is_field() ? 0 : 1;
    if (known[which].of_field != c.is_field())
      throw Error(Errc::usage, "--units", fmt::format("{} is not a unit for {}", units[which], c.quantity));
    if (c.unit && c.unit->in_si != known[which].in_si)
      throw Error(Errc::usage, "--units",
                  fmt::format("{} differs from the unit of {} in the file, {}", units[which], c.quantity,
                              c.unit_text));
    c.unit = known[which];
    c.unit_text = units[which];
  }
}

void check_columns(const FieldLines& f, const std::vector<UsedColumn>& used) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    const FieldColumn& c = used[i].column;
    if (!c.unit)
      throw Error(
          Errc::input, f.file,
          fmt::format("column \"{}\" has no known unit{}; write it like \"{} ({})\", or give --units with "
                      "one unit of length and one of field, such as --units cm,G",
                      c.quantity, c.unit_text.empty() ? "" : fmt::format(" (\"{}\")", c.unit_text),
                      c.quantity, c.is_field() ? "mT" : "mm"));
    for (std::size_t k = 0; k < i; ++k)
      if (used[k].column.quantity == c.quantity)
        throw Error(Errc::input, f.file,
                    fmt::format("has two columns for {}; rename one of them", c.quantity));
  }
}

double value_of(const FieldLines& f, std::size_t line, const UsedColumn& used) {
  const std::string& text = f.lines[line].fields[used.index];
  if (text.empty())
    throw Error(Errc::input, f.location(line),
                fmt::format("a value is missing in column {}", used.column.quantity));
  const auto number = f.number(text);
  if (!number)
    throw Error(Errc::input, f.location(line),
                fmt::format("\"{}\" in column {} is not a number", text.substr(0, 40), used.column.quantity));
  if (!std::isfinite(*number))
    throw Error(Errc::input, f.location(line),
                fmt::format("the value in column {} is {}; remove the line", used.column.quantity, text));
  return *number;
}

// Decimal points and commas in one table: one of them separates thousands.
void check_decimals(const FieldLines& f, const std::vector<UsedColumn>& used) {
  if (f.separator == ',') return;
  bool point = false;
  std::optional<std::size_t> comma;
  for (std::size_t i = f.first_data; i < f.lines.size(); ++i)
    for (const UsedColumn& u : used) {
      if (u.index >= f.lines[i].fields.size()) continue;
      const std::string& text = f.lines[i].fields[u.index];
      point = point || text.find('.') != std::string::npos;
      if (text.find(',') != std::string::npos && !comma) comma = i;
    }
  if (point && comma)
    throw Error(
        Errc::input, f.location(*comma),
        "has a comma in a number, but other numbers have a point; use one of them for decimals and no "
        "separators of thousands");
}

}  // namespace

Table read_field_table(const std::filesystem::path& file, const FieldTableFormat& format) {
  const FieldLines f = lines_of(file);
  std::vector<UsedColumn> used = used_columns(f, format);
  if (!format.units.empty()) apply_units(used, format.units);
  check_columns(f, used);
  check_decimals(f, used);
  std::vector<std::string> names;
  names.reserve(used.size());
  for (const UsedColumn& u : used)
    names.push_back(fmt::format("{} ({})", u.column.quantity, u.column.unit_text));
  std::vector<std::vector<double>> columns(used.size());
  std::vector<std::size_t> numbers;
  const std::size_t width = format.columns.empty() ? f.width() : format.columns.size();
  for (std::size_t i = f.first_data; i < f.lines.size(); ++i) {
    if (f.lines[i].fields.size() != width)
      throw Error(
          Errc::input, f.location(i),
          fmt::format("{} fields, but {} columns; separate columns with semicolons or tabs if decimals "
                      "have a comma",
                      f.lines[i].fields.size(), width));
    for (std::size_t k = 0; k < used.size(); ++k) columns[k].push_back(value_of(f, i, used[k]));
    numbers.push_back(f.lines[i].number);
  }
  return Table(f.file, std::move(names), std::move(columns), std::move(numbers));
}

}  // namespace faba
