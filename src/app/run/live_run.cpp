#include "app/run/live_run.h"
#include "app/scenario/read_event.h"
#include "app/scenario/read_scenario.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace faba {

LiveRun::LiveRun(const Document& d, std::uint64_t seed, const Parts& parts, Pool& pool)
    : parts_(parts), began_(read_scenario(d, parts)), seed_(seed) {
  began_.params.seed = seed;
  // Every frame can be rendered as the camera sees it; recorded() has the settings of the recording.
  Scenario rendered = began_;
  rendered.record.as_seen = true;
  simulation_ = std::make_unique<Simulation>(rendered, seed, pool);
  now_ = began_;
  now_.events.clear();
}

void LiveRun::run(const std::function<bool()>& keep_running) {
  faba::run(simulation_->loop(), std::numeric_limits<std::uint64_t>::max(), keep_running);
}

void LiveRun::exchange(const Json& event) {
  for (; passed_ < began_.events.size() && began_.events[passed_].frame < frame(); ++passed_)
    change(began_.events[passed_], now_);
  if (!event.is_object()) throw Error(Errc::usage, "event", "must be a table of parts");
  Document d;
  d.root = event;
  d.root["frame"] = frame();
  Scenario next = now_;
  Event e = read_event(Node(d), next, parts_);
  simulation_->apply(e);
  now_ = std::move(next);
  // Several exchanges of the same parts between two frames, as during dragging of a field, are merged.
  if (!given_.empty() && given_.back().frame == e.frame && !e.model && !given_.back().model) {
    Event& last = given_.back();
    if (e.estimator) last.estimator = std::move(e.estimator);
    if (e.reference) last.reference = std::move(e.reference);
    if (e.controller) last.controller = std::move(e.controller);
  } else {
    given_.push_back(std::move(e));
  }
}

Scenario LiveRun::recorded() const {
  Scenario s = began_;
  s.params.duration = double(frame()) * s.frame_period();
  // At the same frame, exchanges come before events of the file.
  s.events.clear();
  std::merge(given_.begin(), given_.end(), began_.events.begin(), began_.events.end(),
             std::back_inserter(s.events), [](const Event& a, const Event& b) { return a.frame < b.frame; });
  std::erase_if(s.events, [&](const Event& e) { return e.frame >= frame(); });  // not yet applied
  return s;
}

std::string LiveRun::state_hash() const { return simulation_->state_hash(); }

}  // namespace faba
