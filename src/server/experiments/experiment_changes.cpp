#include "server/experiments/experiment_changes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace faba {
namespace {

constexpr std::size_t kMostChanges = 1000;

// The key that identifies the items of a list; empty for any other value.
std::string identity_of(const std::string& key) {
  return key == "drop" ? "name" : key == "video" ? "file" : "";
}

[[noreturn]] void unknown_path(const std::vector<std::string>& path) {
  throw Error(Errc::usage, fmt::format("{}", fmt::join(path, ".")),
              "is not the path of a value of an experiment");
}

// The position of an item in a list; its size if the list has no such item.
std::size_t position(const Json& list, const std::string& identity, const std::string& value) {
  const auto it = std::find_if(list.begin(), list.end(), [&](const Json& item) {
    return item.is_object() && item.value(identity, "") == value;
  });
  return std::size_t(it - list.begin());
}

Json present(const Json& experiment, const std::vector<std::string>& path) {
  if (path.empty() || path.size() > 3) unknown_path(path);
  const auto top = experiment.find(path[0]);
  if (path.size() == 1) return top == experiment.end() ? Json() : *top;
  const std::string identity = identity_of(path[0]);
  if (identity.empty()) unknown_path(path);
  if (top == experiment.end() || !top->is_array()) return {};
  const std::size_t i = position(*top, identity, path[1]);
  if (i == top->size()) return {};
  if (path.size() == 2) return (*top)[i];
  const auto value = (*top)[i].find(path[2]);
  return value == (*top)[i].end() ? Json() : *value;
}

void set_key(Json& table, const std::string& key, const Json& to) {
  if (to.is_null())
    table.erase(key);
  else
    table[key] = to;
}

void set_value(Json& experiment, const ExperimentChange& c) {
  if (c.path.size() == 1) {
    if (!identity_of(c.path[0]).empty()) unknown_path(c.path);  // a list is changed by item
    return set_key(experiment, c.path[0], c.to);
  }
  Json& list = experiment[c.path[0]];
  if (!list.is_array()) list = Json::array();
  const std::string identity = identity_of(c.path[0]);
  const std::size_t i = position(list, identity, c.path[1]);
  if (c.path.size() == 3) {
    if (i == list.size()) unknown_path(c.path);
    return set_key(list[i], c.path[2], c.to);
  }
  if (c.to.is_null()) {
    if (i < list.size()) list.erase(i);
    return;
  }
  Json item = c.to;
  item[identity] = c.path[1];
  if (i == list.size())
    list.push_back(std::move(item));
  else
    list[i] = std::move(item);
}

}  // namespace

std::vector<ExperimentChange> changes_of(const Json& asked) {
  std::vector<ExperimentChange> changes;
  const auto list = asked.find("changes");
  if (list == asked.end() || !list->is_array() || list->empty() || list->size() > kMostChanges)
    throw Error(Errc::usage, "changes", fmt::format("must be a list of 1 to {} changes", kMostChanges));
  for (const Json& one : *list) {
    ExperimentChange c;
    c.path = one.at("path").get<std::vector<std::string>>();
    c.from = one.value("from", Json());
    c.to = one.value("to", Json());
    changes.push_back(std::move(c));
  }
  return changes;
}

std::vector<ChangeConflict> apply_changes(Json& experiment, const std::vector<ExperimentChange>& changes) {
  std::vector<ChangeConflict> conflicts;
  Json changed = experiment;
  for (const ExperimentChange& c : changes) {
    const Json now = present(changed, c.path);
    if (now == c.to) continue;  // made by another page already
    if (now != c.from) {
      conflicts.push_back({c.path, now});
      continue;
    }
    set_value(changed, c);
  }
  if (conflicts.empty()) experiment = std::move(changed);
  return conflicts;
}

}  // namespace faba
