#include "demo/browser_lab.h"

#include <algorithm>
#include <limits>

#include "app/run/random_seed.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario_schema.h"
#include "core/error.h"
#include "core/json_input.h"
#include "server/json_text.h"
#include "server/scenarios/gallery_index.h"
#include "server/scenarios/scenario_check.h"
#include "server/scenarios/scene_cards.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

constexpr double kLate = 0.25;        // s, maximum lag that is made up for
constexpr double kStatePeriod = 0.5;  // s, interval of state messages

std::vector<fs::path> scenes(const fs::path& gallery) {
  std::vector<fs::path> files;
  for (const auto& e : fs::directory_iterator(gallery))
    if (e.path().extension() == ".toml" && e.path().filename() != kGalleryIndex) files.push_back(e.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool asks_to_finish(std::string_view text) {
  const Json j = parse_json(text);
  return j.is_object() && j.value("do", Json()) == "finish";
}

}  // namespace

BrowserLab::BrowserLab(Page page, fs::path gallery)
    : page_(std::move(page)), gallery_(std::move(gallery)), parts_(engine_parts()), pool_(1) {
  page_.text(json_text({{"say", "hello"}, {"version", FABA_VERSION}, {"protocol", 1}, {"page", 1}}));
  page_.text(json_text({{"say", "pages"}, {"pages", 1}, {"steering", 1}}));
  send_state();
}

// Files that a scenario of the page names are relative to the gallery.
Document BrowserLab::document(Json scenario) const {
  Document d;
  d.name = (gallery_ / "page").string();
  d.root = std::move(scenario);
  return d;
}

// The place of an error without the name of that document.
std::string BrowserLab::in_page(const std::string& where) const {
  const std::string name = (gallery_ / "page").string() + ": ";
  return where.starts_with(name) ? where.substr(name.size()) : where;
}

// Errors other than Error: out of memory, JSON of another type.
Json BrowserLab::refusal(const std::exception& e) const {
  const auto* error = dynamic_cast<const Error*>(&e);
  return {{"ok", false},
          {"where", error ? in_page(error->where()) : ""},
          {"what", error ? error->reason() : e.what()}};
}

Json BrowserLab::check(std::string_view body) const {
  const Json asked = parse_json(body);
  if (!asked.is_object()) throw Error(Errc::usage, "invalid request", "not a JSON object");
  const Document d = asked.contains("toml")
                         ? parse_toml(asked["toml"].get<std::string>(), asked.value("name", "scenario.toml"))
                         : document(asked.value("scenario", Json::object()));
  return scenario_check(d, parts_, ".");
}

ShownRun& BrowserLab::shown() {
  if (!shown_) throw Error(Errc::usage, "run", "no run; start a scenario first");
  return *shown_;
}

double BrowserLab::period() const { return shown_->live.scenario().frame_period(); }

std::uint64_t BrowserLab::end() const { return shown_->live.scenario().frames(); }

void BrowserLab::receive(std::string_view text) {
  Json answer = Json::object();
  std::int64_t id = message_id(text);
  try {
    if (asks_to_finish(text)) {
      shown();
      pause_at_ = end();
      pace(Pace::fastest);
    } else {
      answer = carry_out(parse_page_message(text));
    }
    answer["ok"] = true;
  } catch (const std::exception& e) {
    answer = refusal(e);
  }
  answer["id"] = id;
  page_.text(json_text(answer));
}

Json BrowserLab::carry_out(const PageMessage& m) {
  using Do = PageMessage::Do;
  switch (m.what) {
    case Do::start:
      start(m.scenario, m.seed.value_or(random_seed()));
      return {{"seed", shown_->live.seed()}};
    case Do::restart: {
      const Json scenario = shown().document.root;
      start(scenario, shown_->live.seed());
      break;
    }
    case Do::exchange:
      shown().live.exchange(m.event);
      page_.text(json_text(parts_news(*shown_)));
      if (pace_ == Pace::paused) send_hash();
      break;
    case Do::pause:
      shown();
      pause();
      break;
    case Do::go:
      pause_at_ = shown().live.frame() < end() ? end() : std::numeric_limits<std::uint64_t>::max();
      pace(Pace::real_time);
      break;
    case Do::step:
      pause_at_ = shown().live.frame() + m.frames;
      pace(Pace::real_time);
      break;
    case Do::speed:
      speed_ = m.factor;
      on_time_ = false;
      send_state();
      break;
    case Do::look:
      camera_ = m.camera;
      sites_ = m.sites;
      frame_rate_ = m.rate;
      if (shown_ && pace_ == Pace::paused && shown_->live.frame() > 0) send_frame();
      break;
    case Do::save:
      throw Error(Errc::usage, "save",
                  "the demonstration does not record; install the program to record runs");
    case Do::steer:
    case Do::ping:
      break;
  }
  return Json::object();
}

void BrowserLab::start(const Json& scenario, std::uint64_t seed) {
  auto next = std::make_unique<ShownRun>(document(scenario), seed, parts_, pool_);
  shown_ = std::move(next);
  ++run_;
  pause_at_ = end();
  reported_frame_ = 0;
  real_speed_ = 0;
  page_.text(json_text(run_news(*shown_, run_)));
  pace(Pace::real_time);
}

void BrowserLab::pace(Pace p) {
  pace_ = p;
  on_time_ = false;
  reported_ = page_.clock();
  reported_frame_ = shown_->live.frame();
  send_state();
}

void BrowserLab::pause() {
  pace_ = Pace::paused;
  send_state();
  if (shown_->live.frame() > 0) {
    send_frame();
    send_hash();
  }
}

// One frame. Returns false if the run has stopped with an error, which the page has received.
bool BrowserLab::step() {
  try {
    if (run_cycle(shown_->live.simulation().loop())) return true;
  } catch (const Error& e) {
    page_.text(json_text({{"say", "stopped"}, {"where", in_page(e.where())}, {"what", e.reason()}}));
  }
  pace_ = Pace::paused;
  return false;
}

double BrowserLab::advance(double budget) {
  if (pace_ == Pace::paused) return std::numeric_limits<double>::infinity();
  const double began = page_.clock();
  double now = began;
  if (!on_time_ || now - due_ > kLate) due_ = now;
  on_time_ = true;
  bool fresh = false;
  while (pace_ != Pace::paused && (pace_ == Pace::fastest || due_ <= now)) {
    if (shown_->live.frame() >= pause_at_) {
      pause();
      return std::numeric_limits<double>::infinity();
    }
    if (!step()) return std::numeric_limits<double>::infinity();
    fresh = true;
    due_ += period() / speed_;
    now = page_.clock();
    if (now - began > budget) break;
  }
  if (fresh && now - sent_ > 0.9 / frame_rate_) {
    send_frame();
    sent_ = now;
  }
  measure_speed(now);
  return pace_ == Pace::fastest ? 0 : std::max(0.0, due_ - now);
}

void BrowserLab::measure_speed(double now) {
  if (now - reported_ < kStatePeriod) return;
  real_speed_ = double(shown_->live.frame() - reported_frame_) * period() / (now - reported_);
  reported_ = now;
  reported_frame_ = shown_->live.frame();
  send_state();
}

void BrowserLab::send_frame() { page_.frame(*shown_->message(run_, camera_, sites_)); }

void BrowserLab::send_state() {
  page_.text(json_text({{"say", "state"},
                        {"running", pace_ != Pace::paused},
                        {"speed", speed_},
                        {"real_speed", real_speed_},
                        {"frame", shown_ ? shown_->live.frame() : 0}}));
}

void BrowserLab::send_hash() {
  const LiveRun& live = shown_->live;
  page_.text(json_text({{"say", "hash"},
                        {"run", run_},
                        {"frame", live.frame()},
                        {"t", double(live.frame()) * period()},
                        {"hash", live.state_hash()},
                        {"end", live.frame() == end()},
                        {"changed", live.exchanges() > 0}}));
}

Json BrowserLab::answer(std::string_view path, std::string_view body) {
  constexpr std::string_view kScene = "/api/scenes/";
  try {
    if (path == "/api/schema") return scenario_json_schema(parts_);
    if (path == "/api/scenes") return scene_cards(gallery_, scenes(gallery_), parts_);
    if (path == "/api/check") return check(body);
    if (path.starts_with(kScene)) {
      const fs::path name = fs::path(path.substr(kScene.size())).filename();
      return scene_answer(gallery_ / (name.string() + ".toml"), parts_);
    }
    throw Error(Errc::usage, std::string(path), "not available in the demonstration; install the program");
  } catch (const std::exception& e) {
    return refusal(e);
  }
}

}  // namespace faba
