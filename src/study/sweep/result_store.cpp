#include "study/sweep/result_store.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "core/toml.h"

namespace faba {
namespace {

// JSON has no NaN: values that are not finite are written as null.
std::string line_of(const std::string& key, const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(std::isfinite(v) ? Json(v) : Json());
  return Json{{"task", key}, {"values", list}}.dump() + "\n";
}

}  // namespace

ResultStore::ResultStore(const std::filesystem::path& file) {
  const std::uint64_t complete = std::filesystem::exists(file) ? read(file) : 0;
  file_ = std::make_unique<OutputFile>(file, complete);
}
ResultStore::~ResultStore() = default;

// Number of bytes up to the end of the last complete line.
std::uint64_t ResultStore::read(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  std::size_t begin = 0, number = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++number;
    const Json j =
        Json::parse(text.begin() + std::ptrdiff_t(begin), text.begin() + std::ptrdiff_t(end), nullptr, false);
    const bool good = j.is_object() && j.contains("task") && j["task"].is_string() && j.contains("values") &&
                      j["values"].is_array();
    std::vector<double> values;
    for (const Json& v : good ? j["values"] : Json::array())
      values.push_back(v.is_number() ? v.get<double>() : std::numeric_limits<double>::quiet_NaN());
    if (!good)
      throw Error(Errc::input, fmt::format("{}:{}", file.string(), number),
                  "is not a result of a study; delete the file to compute all results again");
    results_.emplace(j["task"].get<std::string>(), std::move(values));
  }
  return begin;
}

const std::vector<double>* ResultStore::find(const std::string& key) const {
  const auto it = results_.find(key);
  return it == results_.end() ? nullptr : &it->second;
}

void ResultStore::add(const std::string& key, const std::vector<double>& values) {
  if (results_.contains(key)) return;
  file_->append(line_of(key, values));
  results_.emplace(key, values);
}

void ResultStore::merge(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw Error(Errc::input, file.string(), "file not found: the directory contains no results of a study");
  auto mine = std::move(results_);
  results_.clear();
  read(file);
  const auto theirs = std::move(results_);
  results_ = std::move(mine);
  for (const auto& [key, values] : theirs) add(key, values);
}

}  // namespace faba
