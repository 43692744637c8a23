#include "study/motion/histogram_files.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "vision/image/kernels/histogram_distance.h"

namespace faba {
namespace {

// Calls take(text, line number) for every line that is not empty or a comment.
template <class Take>
void each_line(const std::filesystem::path& file, Take&& take) {
  std::istringstream in(read_file(file));
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // byte-order mark
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin != std::string::npos && line[begin] != '#') take(line.substr(begin), number);
  }
}

double number_in(const std::string& words, const std::filesystem::path& file, std::size_t line,
                 const char* advice) {
  double value = 0;
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), value);
  if (error != std::errc() || end != words.data() + words.size() || !std::isfinite(value))
    throw Error(Errc::input, fmt::format("{}:{}", file.string(), line),
                fmt::format("\"{}\" is not a number; {}", words.substr(0, 40), advice));
  if (value < 0)
    throw Error(Errc::input, fmt::format("{}:{}", file.string(), line),
                fmt::format("{} is negative; it must be at least 0", value));
  return value;
}

BinSimilarity similarity_of(const DistanceOptions& o) {
  if (o.similarity.empty()) return BinSimilarity::truncated_linear(o.threshold);
  std::vector<double> matrix;
  std::size_t rows = 0, columns = 0;
  each_line(o.similarity, [&](const std::string& line, std::size_t number) {
    std::istringstream in(line);
    std::size_t n = 0;
    for (std::string one; std::getline(in, one, ','); ++n) {
      const std::size_t a = one.find_first_not_of(" \t"), b = one.find_last_not_of(" \t");
      matrix.push_back(
          number_in(a == std::string::npos ? "" : one.substr(a, b - a + 1), o.similarity, number,
                    "write each row of the matrix in one line, with commas between the numbers"));
    }
    if (rows++ == 0) columns = n;
    if (n != columns)
      throw Error(Errc::input, fmt::format("{}:{}", o.similarity.string(), number),
                  fmt::format("has {} numbers, but the first row has {}", n, columns));
  });
  if (rows != columns) columns = 0;  // refused by BinSimilarity::given()
  return BinSimilarity::given(std::move(matrix), columns, o.similarity.string());
}

}  // namespace

std::vector<double> read_histogram(const std::filesystem::path& file) {
  std::vector<double> bins;
  each_line(file, [&](const std::string& line, std::size_t number) {
    bins.push_back(number_in(line, file, number, "write one number per line"));
  });
  if (bins.empty())
    throw Error(Errc::input, file.string(), "contains no numbers; a histogram has one per line");
  return bins;
}

std::vector<double> histogram_distances(const std::filesystem::path& first,
                                        const std::vector<std::filesystem::path>& others,
                                        const DistanceOptions& o) {
  HistogramDistance distance(similarity_of(o), o.m);
  const auto read = [&](const std::filesystem::path& file) {
    std::vector<double> bins = read_histogram(file);
    if (!o.normalise) return bins;
    double sum = 0;
    for (const double b : bins) sum += b;
    if (!(sum > 0))
      throw Error(Errc::input, file.string(), "all bins are 0; such a histogram cannot be normalised");
    for (double& b : bins) b /= sum;
    return bins;
  };
  const std::vector<double> p = read(first);
  std::vector<double> out;
  for (const auto& file : others) {
    const std::vector<double> q = read(file);
    if (q.size() != p.size())
      throw Error(Errc::input, file.string(),
                  fmt::format("has {} bins, but {} has {}", q.size(), first.string(), p.size()));
    out.push_back(distance(p, q));
  }
  return out;
}

}  // namespace faba
