#include "server/experiments/experiment_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "server/experiments/experiment_changes.h"
#include "server/files/opened_input.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kFolder = "experiments";
constexpr const char* kVideoFolder = "videos";
constexpr std::size_t kLongestName = 80;

// Of the content of a file: pages compare it with the one that they have.
std::string revision_of(const std::string& content) {
  Hash h;
  h.text(content);
  return h.hex();
}

std::string shown_folder(const std::string& name) { return fmt::format("{}/{}", kFolder, name); }

Json card(const std::string& name, const ExperimentStore& store) {
  try {
    const Experiment e = with_opened(store.folder(name), shown_folder(name), [](const fs::path& dir) {
      return read_experiment(dir / kExperimentFile);
    });
    return {{"name", name}, {"title", e.title}, {"drops", e.drops.size()}, {"videos", e.videos.size()}};
  } catch (const Error& e) {
    return {{"name", name}, {"title", name}, {"error", e.what()}};
  }
}

bool has_drop(const Document& d, const std::string& drop) {
  const Experiment e = read_experiment(d);
  return std::ranges::find(e.drops, drop, &ExperimentDrop::name) != e.drops.end();
}

// The list of videos; an experiment may have none.
Json& videos_of(Document& d) {
  Json& list = d.root["video"];
  if (!list.is_array()) list = Json::array();
  return list;
}

std::size_t position_of(const Json& videos, const std::string& file) {
  std::size_t i = 0;
  while (i < videos.size() && videos[i].value("file", "") != file) ++i;
  return i;
}

bool is_utf8(const std::string& text) {
  try {
    (void)Json(text).dump();
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

// The character of valid UTF-8 that begins at a byte.
std::string character_at(const std::string& text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return text.substr(at, end - at);
}

// Controls of Unicode (U+0080 to U+009F) and characters that are invisible or change the direction of text: a
// name with them looks like another one.
bool is_invisible(const std::string& character) {
  using Range = std::pair<std::string_view, std::string_view>;
  // UTF-8 has the order of the code points.
  static constexpr Range kInvisible[] = {
      {"\xC2\x80", "\xC2\x9F"},          // controls
      {"\xC2\xAD", "\xC2\xAD"},          // soft hyphen
      {"\xD8\x9C", "\xD8\x9C"},          // Arabic letter mark
      {"\xE1\xA0\x8E", "\xE1\xA0\x8E"},  // Mongolian vowel separator
      {"\xE2\x80\x8B", "\xE2\x80\x8F"},  // zero width, marks of direction
      // NOLINTNEXTLINE(misc-misleading-bidirectional): the characters that are looked for
      {"\xE2\x80\xA8", "\xE2\x80\xAE"},           // line separators, embeddings, overrides
      {"\xE2\x81\xA0", "\xE2\x81\xAF"},           // word joiner, isolates
      {"\xEF\xBB\xBF", "\xEF\xBB\xBF"},           // byte order mark
      {"\xEF\xBF\xB9", "\xEF\xBF\xBB"},           // annotations
      {"\xF3\xA0\x80\x80", "\xF3\xA0\x81\xBF"}};  // tags
  const std::string_view c = character;
  return std::any_of(std::begin(kInvisible), std::end(kInvisible), [&](const Range& r) {
    return c.size() == r.first.size() && c >= r.first && c <= r.second;
  });
}

}  // namespace

std::string safe_name(const std::string& text) {
  std::string name;
  const bool unicode = is_utf8(text);
  for (std::size_t at = 0; at < text.size();) {
    const std::string character = unicode ? character_at(text, at) : text.substr(at, 1);
    at += character.size();
    const auto u = static_cast<unsigned char>(character[0]);
    // Letters of UTF-8 remain as they are; other bytes would make the experiment file invalid.
    const bool good =
        u < 0x80 ? std::isalnum(u) || u == '.' || u == '_' : unicode && !is_invisible(character);
    if (good)
      name += character;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  name.erase(0, name.find_first_not_of(".-"));
  while (name.size() > kLongestName) {
    // A complete character of UTF-8.
    while (!name.empty() && (static_cast<unsigned char>(name.back()) & 0xC0) == 0x80) name.pop_back();
    if (!name.empty()) name.pop_back();
  }
  while (!name.empty() && (name.back() == '-' || name.back() == '.')) name.pop_back();
  return name;
}

fs::path ExperimentStore::folder(const std::string& name) const {
  fs::path dir = workspace_.inside(shown_folder(name));
  if (name.empty() || name.find('/') != name.npos || !experiment_file(dir))
    throw Error(Errc::input, name.substr(0, kLongestName), "experiment not found");
  workspace_.check_links(dir);
  return dir;
}

fs::path ExperimentStore::video_folder(const std::string& name) const {
  with_opened(folder(name), shown_folder(name),
              [](const fs::path& dir) { fs::create_directory(dir / kVideoFolder); });
  return workspace_.inside(fmt::format("{}/{}", shown_folder(name), kVideoFolder));
}

Json ExperimentStore::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(workspace_.root() / kFolder, ec)) {
    const std::string name = e.path().filename();
    if (const auto file = experiment_file(e.path()); file && !name.starts_with('.'))
      found.emplace_back(fs::last_write_time(*file, ec), name);
  }
  std::sort(found.rbegin(), found.rend());
  Json all = Json::array();
  for (const auto& [_, name] : found) all.push_back(card(name, *this));
  return all;
}

std::string ExperimentStore::create(const std::string& title) {
  const std::lock_guard lock(mutex_);
  std::string wanted = safe_name(title);
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](unsigned char c) { return char(c < 0x80 ? std::tolower(c) : c); });
  if (wanted.empty())
    throw Error(Errc::usage, "title", fmt::format("\"{}\" must have at least one letter or digit", title));
  std::string name = wanted;
  for (int i = 2; fs::exists(workspace_.root() / kFolder / name); ++i) name = fmt::format("{}-{}", wanted, i);
  const fs::path dir = workspace_.inside(fmt::format("{}/{}", kFolder, name));
  fs::create_directories(dir / kVideoFolder);
  write_file(dir / kExperimentFile, to_toml({{"title", title}}));
  return name;
}

Json ExperimentStore::read(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return read_locked(name);
}

Json ExperimentStore::read_locked(const std::string& name) const {
  return with_opened(folder(name), shown_folder(name), [&](const fs::path& dir) -> Json {
    const fs::path file = dir / kExperimentFile;
    const Document d = read_toml(file);
    (void)read_experiment(d);
    return {{"name", name}, {"revision", revision_of(read_file(file))}, {"experiment", d.root}};
  });
}

Document ExperimentStore::document(const std::string& name) const {
  Document d = with_opened(folder(name), shown_folder(name), [](const fs::path& dir) {
    Document read = read_toml(dir / kExperimentFile);
    (void)read_experiment(read);
    return read;
  });
  d.name = kExperimentFile;
  d.origin.clear();  // lines of this file, which is changed
  return d;
}

Json ExperimentStore::change(const std::string& name, const Json& asked) {
  const std::vector<ExperimentChange> changes = changes_of(asked);
  const std::lock_guard lock(mutex_);
  Document d = document(name);
  const std::vector<ChangeConflict> conflicts = apply_changes(d.root, changes);
  if (conflicts.empty()) write_locked(name, std::move(d));
  Json answer = read_locked(name);
  if (conflicts.empty()) return answer;
  answer["conflicts"] = Json::array();
  for (const ChangeConflict& c : conflicts) answer["conflicts"].push_back({{"path", c.path}, {"now", c.now}});
  return answer;
}

void ExperimentStore::add_video(const std::string& name, const std::string& file, const std::string& drop) {
  const std::lock_guard lock(mutex_);
  Document d = document(name);
  Json video = {{"file", file}};
  // Another page may have removed the drop during the upload.
  if (has_drop(d, drop)) video["drop"] = drop;
  videos_of(d).push_back(std::move(video));
  write_locked(name, std::move(d));
}

void ExperimentStore::add_recording(const std::string& name, Json video, int polarity) {
  const std::lock_guard lock(mutex_);
  Document d = document(name);
  if (const std::string drop = video.value("drop", ""); !drop.empty()) {
    if (!d.root["drop"].is_array()) d.root["drop"] = Json::array();
    if (!has_drop(d, drop)) d.root["drop"].push_back({{"name", drop}});
    for (Json& known : d.root["drop"])
      if (known.value("name", "") == drop && polarity != 0 &&
          known.value("polarity", "unknown") == std::string("unknown"))
        known["polarity"] = polarity > 0 ? "north" : "south";
  }
  videos_of(d).push_back(std::move(video));
  write_locked(name, std::move(d));
}

VideoEntry ExperimentStore::video(const std::string& name, const std::string& file) const {
  const std::lock_guard lock(mutex_);
  Document d = document(name);
  const Json& videos = videos_of(d);
  const std::size_t i = position_of(videos, file);
  if (i == videos.size())
    throw Error(Errc::input, file.substr(0, kLongestName), "is not a video of this experiment");
  return {i, videos[i]};
}

void ExperimentStore::remove_video(const std::string& name, const std::string& file) {
  const std::lock_guard lock(mutex_);
  Document d = document(name);
  Json& videos = videos_of(d);
  const std::size_t i = position_of(videos, file);
  if (i == videos.size()) return;
  videos.erase(i);
  write_locked(name, std::move(d));
}

void ExperimentStore::restore_video(const std::string& name, const VideoEntry& entry) {
  const std::lock_guard lock(mutex_);
  Document d = document(name);
  Json& videos = videos_of(d);
  if (position_of(videos, entry.values.value("file", "")) < videos.size()) return;
  Json values = entry.values;
  // Another page may have removed the drop meanwhile.
  if (!has_drop(d, values.value("drop", ""))) values.erase("drop");
  videos.insert(videos.begin() + std::ptrdiff_t(std::min(entry.position, videos.size())), std::move(values));
  write_locked(name, std::move(d));
}

std::vector<std::string> ExperimentStore::users_of(const fs::path& file, const std::string& but) const {
  std::vector<std::string> users;
  const auto is_file = [real = fs::weakly_canonical(file)](const fs::path& other) {
    std::error_code ec;
    return fs::weakly_canonical(other, ec) == real;
  };
  for (const Json& one : list()) {
    if (one.contains("error")) continue;
    const std::string name = one["name"];
    const fs::path dir = folder(name);
    const Experiment e = read_experiment(dir / kExperimentFile);
    const bool shows = name != but && std::ranges::any_of(e.videos, [&](const ExperimentVideo& v) {
                         return is_file(video_path(dir / kExperimentFile, v));
                       });
    if (shows || (!e.noise.empty() && is_file(dir / e.noise))) users.push_back(name);
  }
  return users;
}

void ExperimentStore::write_locked(const std::string& name, Document d) {
  const fs::path dir = folder(name);
  check_videos(dir / kExperimentFile, read_experiment(d));
  with_opened(dir, shown_folder(name),
              [&](const fs::path& opened) { write_file(opened / kExperimentFile, to_toml(d.root)); });
  changed_(name);
}

// A video that a page names may lie in another folder of the workspace, but not outside of what pages may
// read.
void ExperimentStore::check_videos(const fs::path& file, const Experiment& e) const {
  for (const ExperimentVideo& v : e.videos)
    if (!workspace_.may_read(video_path(file, v)))
      throw Error(Errc::usage, v.file,
                  "is neither in the folder in which the lab was started nor in a folder given by "
                  "--allow");
}

}  // namespace faba
