#include "server/api/api.h"

#include "core/error.h"
#include "server/api/responses.h"
#include "server/bench/bench_recordings.h"
#include "server/embedded_page.h"
#include "server/json_text.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

WebResponse failure(int status, const Error& e) {
  return {.status = status, .body = json_text({{"ok", false}, {"where", e.where()}, {"what", e.reason()}})};
}

}  // namespace

Api::Api(const Workspace& workspace, JobList& jobs, fs::path pictures, fs::path pages,
         std::function<void(const Json&)> news)
    : pages_(std::move(pages)),
      experiments_(workspace,
                   [news](const std::string& name) {
                     news({{"say", "experiment"}, {"name", name}});
                   }),
      bench_(
          [news = std::move(news)](const Json& state) {
            news({{"say", "bench"}, {"state", state}});
          },
          [this](const BenchRecording& r) { keep_recording(experiments_, r); }),
      trash_(workspace),
      runs_(workspace, jobs, trash_),
      lab_{workspace, jobs,  std::move(pictures), builtin_parts(), bench_, experiments_, imports_,
           runs_,     trash_} {
  routes_.add("GET", "/api/about", [this](const auto&, const auto&) {
    return json_answer({{"version", FABA_VERSION}, {"workspace", lab_.workspace.root()}});
  });
  add_scenario_routes(routes_, lab_);
  add_gallery_routes(routes_, lab_);
  add_result_routes(routes_, lab_);
  add_run_routes(routes_, lab_);
  add_experiment_routes(routes_, lab_);
  add_folder_routes(routes_, lab_);
  add_job_routes(routes_, lab_);
  add_track_routes(routes_, lab_);
  add_trash_routes(routes_, lab_);
  add_input_routes(routes_, lab_);
  add_upload_routes(routes_, lab_);
  add_video_routes(routes_, lab_);
  add_bench_routes(routes_, lab_);
  add_coil_routes(routes_, lab_);
  add_optics_routes(routes_);
}

WebResponse Api::answer(const WebRequest& r) {
  try {
    if (auto found = routes_.answer(r)) return *std::move(found);
    const bool get = r.method == "GET" || r.method == "HEAD";
    if (get && !r.path.starts_with("/api/"))
      return page_file(r.path == "/" ? "index.html" : r.path.substr(1));
    throw Error(Errc::input, r.path, "not found");
  } catch (const Error& e) {
    return failure(e.code() == Errc::input ? 404 : e.code() == Errc::usage ? 422 : 500, e);
  } catch (const Json::exception&) {
    return failure(422, {Errc::usage, "invalid request", "a value has the wrong type"});
  } catch (const std::exception& e) {
    return failure(500, {Errc::internal, "", e.what()});
  }
}

WebResponse Api::page_file(const std::string& name) const {
  if (!pages_.empty()) {
    const fs::path file = pages_ / fs::path(name).filename();
    if (!fs::is_regular_file(file)) throw Error(Errc::input, name, "not found");
    return file_answer(fs::canonical(file));
  }
  const auto content = embedded_page(name);
  if (!content) throw Error(Errc::input, name, "not found");
  return {.type = content_type(name), .body = std::string(*content)};
}

}  // namespace faba
