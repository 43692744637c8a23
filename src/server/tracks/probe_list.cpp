#include "server/tracks/probe_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "study/data/run_video.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kKeptSurveys = 3;
constexpr std::chrono::milliseconds kPatience{150};

// Changes with the content of the video.
std::string key_of(const fs::path& video, double fps) {
  std::error_code ec;
  const auto size = fs::is_regular_file(video, ec) ? fs::file_size(video, ec) : 0;
  return fmt::format("{}\n{} {} {}", video.string(), size,
                     fs::last_write_time(video, ec).time_since_epoch().count(), fps);
}

std::string key_of(const TrackOptions& o) {
  const PixelRegion r = o.region.value_or(PixelRegion{});
  return fmt::format("{} {} {} {} {} {} {} {} {}", key_of(o.video, o.part.fps), o.part.from_s,
                     o.part.to_s.value_or(-1), o.region.has_value(), r.col, r.row, r.width, r.height,
                     o.inside_drop);
}

// Moves the element with the key to the front. False if no element has it.
template <class List, class KeyOf>
bool to_front(List& list, const std::string& key, const KeyOf& key_of_element) {
  const auto it =
      std::find_if(list.begin(), list.end(), [&](const auto& e) { return key_of_element(e) == key; });
  if (it == list.end()) return false;
  list.splice(list.begin(), list, it);
  return true;
}

}  // namespace

ProbeList::~ProbeList() {
  for (const auto& s : surveys_) s->thread.request_stop();
  for (const auto& s : surveys_) s->thread.join();
}

std::shared_ptr<ProbeList::Survey> ProbeList::begin(const std::string& key, const TrackOptions& options) {
  auto survey = std::make_shared<Survey>();
  survey->key = key;
  surveys_.push_front(survey);
  // The thread is joined before the survey is removed, so that the reference remains valid.
  survey->thread = std::jthread([this, &s = *survey, options](const std::stop_token& stop) {
    std::shared_ptr<TrackProbe> probe;
    std::exception_ptr error;
    try {
      probe = std::make_shared<TrackProbe>(options, run_video(options.video),
                                           [&](std::int64_t done, std::int64_t of) {
                                             const std::lock_guard lock(mutex_);
                                             s.state.done = done;
                                             s.state.of = of;
                                             return !stop.stop_requested();
                                           });
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    s.state.probe = std::move(probe);
    s.error = error;
    changed_.notify_all();
  });
  return survey;
}

ProbeList::State ProbeList::get(const TrackOptions& options) {
  const std::string key = key_of(options);
  std::list<std::shared_ptr<Survey>> dropped;  // joined without the lock
  State state;
  std::exception_ptr error;
  {
    std::unique_lock lock(mutex_);
    if (!to_front(surveys_, key, [](const auto& s) { return s->key; })) begin(key, options);
    const std::shared_ptr<Survey> survey = surveys_.front();
    while (surveys_.size() > kKeptSurveys)
      dropped.splice(dropped.begin(), surveys_, std::prev(surveys_.end()));
    changed_.wait_for(lock, kPatience, [&] { return survey->state.probe || survey->error; });
    state = survey->state;
    error = survey->error;
    // The next request tries again.
    if (error) {
      const auto it = std::find(surveys_.begin(), surveys_.end(), survey);
      if (it != surveys_.end()) dropped.splice(dropped.begin(), surveys_, it);
    }
  }
  for (const auto& s : dropped) s->thread.request_stop();
  for (const auto& s : dropped)
    if (s->thread.joinable()) s->thread.join();
  if (error) std::rethrow_exception(error);
  return state;
}

}  // namespace faba
