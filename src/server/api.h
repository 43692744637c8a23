#pragma once
#include <functional>

#include "app/bench/bench_view.h"
#include "app/scenario/parts.h"
#include "server/job_list.h"
#include "server/web_server.h"
#include "server/workspace.h"

namespace faba {

/// HTTP interface of the lab; see web/protocol.md. Thread-safe.
class Api {
 public:
  /// `pictures`: a private folder for rendered images and uploads. `pages`: folder with the files of the
  /// page, for development; empty: the files embedded in the program.
  Api(const Workspace& workspace, JobList& jobs, std::filesystem::path pictures, std::filesystem::path pages);

  /// Never throws: errors become responses with a status and {"where", "what"}.
  WebResponse answer(const WebRequest& r);

 private:
  using Rest = const std::string&;
  WebResponse route(const WebRequest& r);
  WebResponse page_file(Rest name);
  Json scenes() const;
  WebResponse scene(Rest rest);
  WebResponse run(const WebRequest& r, Rest rest);
  Json check(const Json& asked) const;
  Json take_upload(const WebRequest& r);
  Json start_job(const Json& asked);
  Json bench(const Json& asked, Rest what);
  Json measure_ruler(const Json& asked);
  std::filesystem::path picture_of(const std::filesystem::path& scene);

  const Workspace& workspace_;
  JobList& jobs_;
  std::filesystem::path pictures_, pages_;
  Parts parts_;
  BenchView bench_;
};

}  // namespace faba
