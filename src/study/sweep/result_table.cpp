#include "study/sweep/result_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/h5/h5.h"
#include "core/table.h"

namespace faba {
namespace {

constexpr std::uint64_t kRowsPerChunk = 1024;
constexpr std::size_t kFlush = 1 << 20;  // bytes of CSV

const TaskLabel* label_named(const std::vector<TaskLabel>& labels, const std::string& name) {
  const auto it =
      std::find_if(labels.begin(), labels.end(), [&](const TaskLabel& l) { return l.name == name; });
  return it == labels.end() ? nullptr : &*it;
}

}  // namespace

ResultTable::ResultTable(const ResultStore& store, std::vector<PlannedRound> planned,
                         const std::function<Round(const PlannedRound&)>& round_of,
                         const std::vector<std::string>& value_names)
    : store_(store), planned_(std::move(planned)) {
  for (const PlannedRound& p : planned_) made_.push_back(round_of(p));
  std::size_t most = 0;
  each_row([&](const Row& row) {
    ++rows_;
    most = std::max(most, row.values.size());
    for (const TaskLabel& l : row.labels) add_label(l);
  });
  for (std::size_t k = 0; k < most; ++k)
    values_.push_back(k < value_names.size() ? value_names[k] : fmt::format("value_{}", k + 1));
}

void ResultTable::add_label(const TaskLabel& l) {
  auto it = std::find_if(labels_.begin(), labels_.end(), [&](const Label& k) { return k.name == l.name; });
  if (it == labels_.end()) it = labels_.insert(labels_.end(), {l.name});
  if (l.number) return;
  it->numeric = false;
  if (std::find(it->words.begin(), it->words.end(), l.text) == it->words.end()) it->words.push_back(l.text);
}

void ResultTable::each_row(const std::function<void(const Row&)>& take) const {
  for (std::size_t r = 0; r < made_.size(); ++r) {
    const std::uint64_t key = store_.key(made_[r]);
    for (std::uint64_t i = 0; i < made_[r].size; ++i)
      if (const auto values = store_.find({key, i}))
        take({planned_[r].first + i, r + 1, made_[r].labels(i), *values});
  }
}

void ResultTable::write_csv(const std::filesystem::path& file) const {
  const std::filesystem::path temporary = temporary_name(file);
  OutputFile out(temporary);
  std::string text = "task,round";
  for (const Label& l : labels_) text += "," + csv_field(l.name);
  for (const std::string& v : values_) text += "," + csv_field(v);
  text += '\n';
  each_row([&](const Row& row) {
    text += fmt::format("{},{}", row.task, row.round);
    for (const Label& l : labels_) {
      const TaskLabel* label = label_named(row.labels, l.name);
      text += ',';
      if (label) text += label->number ? fmt::format("{}", *label->number) : csv_field(label->text);
    }
    for (std::size_t k = 0; k < values_.size(); ++k) {
      text += ',';
      if (k < row.values.size() && !std::isnan(row.values[k])) text += fmt::format("{}", row.values[k]);
    }
    text += '\n';
    if (text.size() < kFlush) return;
    out.append(text);
    text.clear();
  });
  out.append(text);
  out.close();
  rename_complete(temporary, file);
}

double ResultTable::number_of(const Row& row, const Label& label) const {
  const TaskLabel* l = label_named(row.labels, label.name);
  if (!l) return std::numeric_limits<double>::quiet_NaN();
  if (label.numeric) return l->number.value_or(std::numeric_limits<double>::quiet_NaN());
  return double(std::find(label.words.begin(), label.words.end(), l->text) - label.words.begin());
}

void ResultTable::write_hdf5(const std::filesystem::path& file) const {
  const std::filesystem::path temporary = temporary_name(file);
  H5File h5 = H5File::create(temporary);
  H5Table task = h5.table<std::uint64_t>("task", {}, kRowsPerChunk, 1, true),
          round = h5.table<std::uint64_t>("round", {}, kRowsPerChunk, 1, true);
  const std::size_t columns = std::max<std::size_t>(1, values_.size());
  H5Table values =
      h5.table<double>("values", {columns}, kRowsPerChunk, std::min<std::size_t>(columns, 64), true);
  std::vector<H5Table> labels;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < labels_.size(); ++k) {
    const std::string name = fmt::format("label_{}", k + 1);
    labels.push_back(h5.table<double>(name, {}, kRowsPerChunk, 1, true));
    h5.attribute(name, "name", labels_[k].name);
    if (!labels_[k].numeric) h5.attribute(name, "words", nlohmann::json(labels_[k].words).dump());
  }
  h5.attribute("/", "values", nlohmann::json(values_).dump());
  h5.begin_writing();
  each_row([&](const Row& row) {
    task.append<std::uint64_t>(std::span(&row.task, 1));
    round.append<std::uint64_t>(std::span(&row.round, 1));
    std::vector<double> all(columns, std::numeric_limits<double>::quiet_NaN());
    std::copy(row.values.begin(), row.values.end(), all.begin());
    values.append<double>(all);
    for (std::size_t k = 0; k < labels_.size(); ++k) {
      const double number = number_of(row, labels_[k]);
      labels[k].append<double>(std::span(&number, 1));
    }
  });
  h5.rename_complete(file);
  h5.close();
}

}  // namespace faba
