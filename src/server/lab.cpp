#include "server/lab.h"

#include <fmt/format.h>

#include <chrono>
#include <set>
#include <thread>

#include "app/run/live_run.h"
#include "app/scenario/read_scenario.h"
#include "core/file.h"
#include "core/threads/parallel.h"
#include "server/access.h"
#include "server/api/api.h"
#include "server/experiments/experiment_store.h"
#include "server/jobs/job_words.h"
#include "server/json_text.h"
#include "server/live_lab.h"
#include "server/shown/page_message.h"
#include "server/web_server.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

/// A temporary folder that only this user can read; removed by the destructor.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = (fs::canonical(fs::temp_directory_path()) / "faba-lab-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw Error(Errc::internal, name, "cannot create this folder");
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Requests that change the run; all pages may send the others.
bool needs_steering(PageMessage::Do what) {
  using Do = PageMessage::Do;
  return what != Do::steer && what != Do::look && what != Do::ping;
}

/// Connected pages, the run that they display, and the page that steers. Handlers run on the server's thread.
class Pages {
 public:
  Pages(LiveLab& lab, JobList& jobs, const Workspace& workspace)
      : lab_(lab), jobs_(jobs), workspace_(workspace) {}

  void opened(const PageSocketRef& s) {
    {
      const std::lock_guard lock(mutex_);
      sockets_[s->id()] = s;
      if (steering_ == 0) steering_ = s->id();
    }
    s->send_text(
        json_text({{"say", "hello"}, {"version", FABA_VERSION}, {"protocol", 1}, {"page", s->id()}}));
    broadcast_pages();
    s->send_text(jobs_message());
    lab_.watch(s->id(), {[s](std::shared_ptr<const std::string> bytes) { s->send_frame(std::move(bytes)); },
                         [s](const Json& j) { s->send_text(json_text(j)); }});
  }
  void closed(const PageSocketRef& s) {
    lab_.leave(s->id());
    {
      const std::lock_guard lock(mutex_);
      sockets_.erase(s->id());
      if (steering_ == s->id()) steering_ = sockets_.empty() ? 0 : sockets_.begin()->first;
    }
    broadcast_pages();
  }
  void received(const PageSocketRef& s, std::string_view text) {
    PageMessage m;
    try {
      m = parse_page_message(text);
      if (needs_steering(m.what) && steering() != s->id())
        throw Error(Errc::usage, "steer", "another page is steering; take control first");
      carry_out(m, s);
    } catch (const Error& e) {
      s->send_text(json_text({{"id", m.id ? m.id : message_id(text)},
                              {"ok", false},
                              {"where", e.where()},
                              {"what", e.reason()}}));
    }
  }
  /// `steering` is called with the page that steers, now and after every change.
  void on_steering(std::function<void(std::uint64_t)> steering) {
    {
      const std::lock_guard lock(mutex_);
      steering_changed_ = std::move(steering);
    }
    broadcast_pages();
  }
  void jobs_changed() { broadcast(jobs_message()); }
  void tell(const Json& news) { broadcast(json_text(news)); }

 private:
  void carry_out(const PageMessage& m, const PageSocketRef& s) {
    const LiveLab::Done done = [this, s, id = m.id](Json answer) {
      answer["id"] = id;
      if (answer.contains("where")) answer["where"] = workspace_.in_page(answer["where"]);
      s->send_text(json_text(answer));
    };
    using Do = PageMessage::Do;
    switch (m.what) {
      case Do::start:
        workspace_.check_files(m.scenario);
        return lab_.start(workspace_.page_document(m.scenario), m.seed, done);
      case Do::exchange:
        workspace_.check_files(m.event);
        return lab_.exchange(m.event, done);
      case Do::pause:
        return lab_.pause(true, done);
      case Do::go:
        return lab_.pause(false, done);
      case Do::step:
        return lab_.step(m.frames, done);
      case Do::speed:
        return lab_.speed(m.factor, done);
      case Do::restart:
        return lab_.restart(done);
      case Do::look:
        lab_.set_view(s->id(), {m.camera, m.rate, m.sites});
        return done(Json{{"ok", true}});
      case Do::steer: {
        const std::lock_guard lock(mutex_);
        steering_ = s->id();
      }
        broadcast_pages();
        return done(Json{{"ok", true}});
      case Do::ping:
        return done(Json{{"ok", true}});
      case Do::save:
        return save(m, done);
    }
  }

  // A separate process makes the recording from the recorded events: the live run does not wait for it.
  void save(const PageMessage& m, const LiveLab::Done& done) {
    lab_.recorded(
        [this, m](const Scenario& s, const std::string& state_hash) { return record(m, s, state_hash); },
        done);
  }
  Json record(const PageMessage& m, Scenario s, const std::string& state_hash) {
    if (!m.name.empty()) s.params.title = m.name;
    if (m.as_seen) s.record.as_seen = true;
    const bool up_to_now = cut(s, m);
    std::string slug = safe_name(m.name);
    if (slug.empty()) slug = "lab";
    const fs::path runs = workspace_.inside("runs");
    fs::create_directories(runs);
    const auto used = [](const fs::path& dir) {
      return fs::exists(dir) || fs::exists(dir.string() + ".toml");
    };
    fs::path dir = runs / slug;
    Json answer = Json::object();
    if (used(dir)) answer["taken"] = slug;
    for (int i = 2; used(dir); ++i) dir = runs / fmt::format("{}-{}", slug, i);
    const fs::path scene = dir.string() + ".toml", out = fs::relative(dir, workspace_.root());
    write_file(scene, to_toml(s.resolved()));
    const std::string name = dir.filename().string();
    jobs_.add(
        {.title = up_to_now ? fmt::format("{} ({})", name, state_hash) : name,
         .words = {"run", fs::relative(scene, workspace_.root()).string(), "--out", out.string(), "--json"},
         .page = out / "report.html",
         .out = out});
    answer["name"] = name;
    return answer;
  }
  // The part of the run that a page asked for; returns whether it ends now. The recording starts at 0 s in
  // any case: a part is simulated as the run was.
  static bool cut(Scenario& s, const PageMessage& m) {
    const std::uint64_t now = s.frames();
    if (m.to) s.params.duration = std::min(*m.to, s.params.duration);
    s.record.from = m.from;
    s.record.to.reset();
    const FrameRange part = s.recorded_frames();
    if (part.first >= part.end)
      throw Error(Errc::usage, "from",
                  fmt::format("{:g} s must be before the end of the recorded part at {:g} s", m.from,
                              s.params.duration));
    std::erase_if(s.events, [&](const Event& e) { return e.frame >= part.end; });
    return part.end == now;
  }

  std::uint64_t steering() const {
    const std::lock_guard lock(mutex_);
    return steering_;
  }
  std::string jobs_message() const {
    Json all = Json::array();
    for (const Job& j : jobs_.jobs()) all.push_back(job_json(j));
    return json_text({{"say", "jobs"}, {"jobs", all}});
  }
  void broadcast(const std::string& text) {
    const std::lock_guard lock(mutex_);
    for (const auto& [_, s] : sockets_) s->send_text(text);
  }
  void broadcast_pages() {
    Json j;
    {
      const std::lock_guard lock(mutex_);
      j = {{"say", "pages"}, {"pages", sockets_.size()}, {"steering", steering_}};
      if (steering_changed_) steering_changed_(steering_);
    }
    broadcast(json_text(j));
  }

  LiveLab& lab_;
  JobList& jobs_;
  const Workspace& workspace_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, PageSocketRef> sockets_;
  std::uint64_t steering_ = 0;  ///< id of the steering page; 0: none
  std::function<void(std::uint64_t)> steering_changed_;
};

}  // namespace

void serve_lab(const LabOptions& o) {
  const Workspace workspace(o.workspace, o.scenes, o.allowed);
  const PrivateFolder folder;
  WebServer server(o.port, folder.path());
  const Access access(random_token(), server.port());

  const unsigned threads = o.threads > 0 ? o.threads : std::max(2u, number_of_threads(0)) - 1;
  LiveLab live(threads);
  Pages* pages = nullptr;
  std::mutex wiring;  // jobs may change before `pages` exists
  JobList jobs(
      o.program, workspace.root(),
      [&] {
        const std::lock_guard lock(wiring);
        if (pages) pages->jobs_changed();
      },
      [&](const Job& job) { check_job(job, workspace); });
  Pages watchers(live, jobs, workspace);
  {
    const std::lock_guard lock(wiring);
    pages = &watchers;
  }
  if (!o.scene.empty()) {
    const Document d = read_toml(o.scene);
    const Parts& parts = builtin_parts();
    const std::optional<std::uint64_t> seed = read_scenario(d, parts).params.seed;
    Pool pool(threads);
    // The lab's own thread would report an error to pages only: construct the run here first.
    const LiveRun check(d, seed.value_or(1), parts, pool);
    live.start(d, seed, [](const Json&) {});
  }
  Api api(workspace, jobs, folder.path(), o.pages, [&](const Json& news) { watchers.tell(news); });
  watchers.on_steering([&](std::uint64_t page) { api.steering(page); });

  std::jthread watch([&](const std::stop_token& s) {
    while (!s.stop_requested() && !(o.stop && o.stop->load()))
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.stop();
  });
  const std::string address = fmt::format("{}/?token={}", access.origin(), access.token());
  // The browser opens a file that redirects to the URL: other users can read command lines, but not this
  // file.
  const fs::path door = folder.path() / "open.html";
  write_file(door, fmt::format("<!doctype html><meta http-equiv=refresh content=\"0; url={}\">\n", address));
  fs::permissions(door, fs::perms::owner_read | fs::perms::owner_write);
  o.ready(address, door);
  server.run(access, {[&](const WebRequest& r) { return api.answer(r); },
                      [&](const PageSocketRef& s) { watchers.opened(s); },
                      [&](const PageSocketRef& s, std::string_view text) { watchers.received(s, text); },
                      [&](const PageSocketRef& s) { watchers.closed(s); }});
  const std::lock_guard lock(wiring);
  pages = nullptr;
}

}  // namespace faba
