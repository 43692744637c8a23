#include "vision/files/picture_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

// End of the run of digits that starts at `at`.
std::size_t digits_end(std::string_view s, std::size_t at) {
  while (at < s.size() && digit(s[at])) ++at;
  return at;
}

// Compares runs of digits of any length by value: without leading zeros the longer one is larger.
int compare_numbers(std::string_view a, std::string_view b) {
  const auto bare = [](std::string_view s) {
    const auto first = s.find_first_not_of('0');
    return first == std::string_view::npos ? std::string_view{} : s.substr(first);
  };
  const std::string_view x = bare(a), y = bare(b);
  if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
  return x.compare(y);
}

bool has_picture_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  constexpr std::array kEndings{".tif", ".tiff", ".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".webp"};
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

// Number field "%d" or "%04d" of a pattern: its length (0: none) and the minimum number of digits.
struct NumberField {
  std::size_t length = 0, least_digits = 1;
};
NumberField number_field(std::string_view pattern, std::size_t at) {
  if (pattern[at] != '%') return {};
  const std::size_t end = digits_end(pattern, at + 1);
  if (end >= pattern.size() || pattern[end] != 'd' || end - at > 4) return {};
  std::size_t digits = 0;
  for (const char c : pattern.substr(at + 1, end - at - 1)) digits = 10 * digits + std::size_t(c - '0');
  return {end + 1 - at, std::max<std::size_t>(1, digits)};
}

// Whether `name` from index `n` matches `pattern` from index `p`.
bool matches(std::string_view pattern, std::string_view name, std::size_t p = 0, std::size_t n = 0) {
  for (; p < pattern.size(); ++p) {
    if (pattern[p] == '*') {
      for (std::size_t skip = n; skip <= name.size(); ++skip)
        if (matches(pattern, name, p + 1, skip)) return true;
      return false;
    }
    if (const NumberField field = number_field(pattern, p); field.length > 0) {
      const std::size_t end = digits_end(name, n);
      if (end == n || end - n < field.least_digits) return false;
      return matches(pattern, name, p + field.length, end);
    }
    if (n >= name.size() || (pattern[p] != '?' && pattern[p] != name[n])) return false;
    ++n;
  }
  return n == name.size();
}

bool is_pattern(const std::string& name) {
  if (name.find_first_of("*?") != std::string::npos) return true;
  for (std::size_t i = 0; i < name.size(); ++i)
    if (number_field(name, i).length > 0) return true;
  return false;
}

// Splits a name into alternating pieces: text at even indices, runs of digits at odd indices.
std::vector<std::string> pieces_of(const std::string& name) {
  std::vector<std::string> pieces(1);
  for (std::size_t at = 0; at < name.size();) {
    if (const std::size_t end = digits_end(name, at); end > at) {
      pieces.push_back(name.substr(at, end - at));
      pieces.emplace_back();
      at = end;
    } else {
      pieces.back() += name[at++];
    }
  }
  return pieces;
}

// Values of the single number in which the names differ; empty when they differ elsewhere or do not differ.
std::vector<double> only_number(const std::vector<std::filesystem::path>& files) {
  std::vector<std::vector<std::string>> names;
  names.reserve(files.size());
  for (const auto& f : files) names.push_back(pieces_of(f.filename().string()));
  std::optional<std::size_t> at;
  for (const auto& name : names) {
    if (name.size() != names[0].size()) return {};
    for (std::size_t i = 0; i < name.size(); ++i) {
      if (name[i] == names[0][i]) continue;
      if (i % 2 == 0 || (at && *at != i)) return {};
      at = i;
    }
  }
  std::vector<double> numbers;
  for (const auto& name : names) {
    if (!at || name[*at].size() > 15) return {};
    numbers.push_back(std::stod(name[*at]));
  }
  return numbers;
}

}  // namespace

std::vector<std::filesystem::path> sequence_files(const std::filesystem::path& path) {
  const bool folder = std::filesystem::is_directory(path);
  const std::filesystem::path where = folder ? path : path.has_parent_path() ? path.parent_path() : ".";
  std::error_code failure;
  std::filesystem::directory_iterator entries(where, failure);
  if (failure == std::errc::no_such_file_or_directory)
    throw Error(Errc::input, path.string(), fmt::format("folder {} not found", where.string()));
  if (failure) throw Error(Errc::input, where.string(), "the folder cannot be read: " + failure.message());
  const std::string pattern = path.filename().string();
  std::vector<std::filesystem::path> files;
  for (const auto& entry : entries) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') || !entry.is_regular_file(failure)) continue;
    if (folder ? has_picture_ending(name) : matches(pattern, name)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const std::size_t i_end = digits_end(a, i), j_end = digits_end(b, j);
    if (i_end > i && j_end > j) {
      const int order =
          compare_numbers(std::string_view(a).substr(i, i_end - i), std::string_view(b).substr(j, j_end - j));
      if (order != 0) return order < 0;
      i = i_end;
      j = j_end;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if ((i < a.size()) != (j < b.size())) return j < b.size();
  return a < b;  // leading zeros: 01 before 1
}

bool is_picture_sequence(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return true;
  return is_pattern(path.filename().string()) && !std::filesystem::exists(path, ignored);
}

PictureSequence::PictureSequence(const std::filesystem::path& path, double fps)
    : files_(sequence_files(path)), fps_(fps) {
  if (files_.empty())
    throw Error(Errc::input, path.string(),
                std::filesystem::is_directory(path) ? "the folder contains no pictures (.tif, .png, .jpg, "
                                                      ".pgm ...); specify a video or a folder of pictures"
                                                    : "no file matches this pattern; check the name");
  assign_times();
  Picture first = read_picture(files_.front());
  first_ = std::move(first.grey);
  bits_ = first.bits;
  first_page_count_ = first.pages;
}

void PictureSequence::assign_times() {
  for (std::size_t i = 0; i < files_.size(); ++i) step_index_.push_back(double(i));
  const std::vector<double> numbers = only_number(files_);
  if (numbers.size() < 2) return;
  double step = numbers[1] - numbers[0];
  for (std::size_t i = 1; i < numbers.size(); ++i) step = std::min(step, numbers[i] - numbers[i - 1]);
  if (!(step > 0)) return;
  std::vector<double> steps;
  for (const double n : numbers) {
    steps.push_back((n - numbers[0]) / step);
    if (steps.back() != std::floor(steps.back())) return;
  }
  step_index_ = steps;
}

bool PictureSequence::read(GrayF& frame, double& t_s) {
  while (next_ < files_.size()) {
    const std::size_t at = next_++;
    Picture picture;
    try {
      if (at == 0) {
        picture = {first_, bits_, first_page_count_};
      } else {
        picture = read_picture(files_[at]);
      }
    } catch (const Error& error) {
      if (error.code() != Errc::input) throw;
      if (damaged_++ == 0) damage_ = error.what();
      continue;
    }
    const auto refuse = [&](const std::string& why) { throw Error(Errc::input, files_[at].string(), why); };
    if (picture.pages > 1)
      refuse(
          fmt::format("has {} pages, a picture of a sequence must have one; specify this file alone to read "
                      "it as a video",
                      picture.pages));
    if (picture.grey.width != first_.width || picture.grey.height != first_.height)
      refuse(fmt::format(
          "is {} x {} px, the previous pictures are {} x {} px; all pictures must have the same size",
          picture.grey.width, picture.grey.height, first_.width, first_.height));
    if (picture.bits != bits_)
      refuse(fmt::format(
          "has {} bits per sample, the previous pictures have {}; all pictures must have the same bit depth",
          picture.bits, bits_));
    frame = std::move(picture.grey);
    t_s = step_index_[at] / (fps_ > 0 ? fps_ : 1);
    return true;
  }
  return false;
}

void PictureSequence::seek(double t_s) {
  constexpr double kRounding = 1e-6;  // frame intervals, of times that are computed from them
  const double step = t_s * (fps_ > 0 ? fps_ : 1) + kRounding;
  const auto after = std::upper_bound(step_index_.begin(), step_index_.end(), step);
  next_ = std::size_t(std::max<std::ptrdiff_t>(0, after - step_index_.begin() - 1));
}

}  // namespace faba
