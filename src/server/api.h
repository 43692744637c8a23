#pragma once
#include <functional>

#include "app/bench/bench_view.h"
#include "app/scenario/parts.h"
#include "server/job_list.h"
#include "server/web_server.h"
#include "server/workspace.h"

namespace faba {

/// What the lab answers to requests of its page; web/protocol.md lists the addresses. Thread-safe.
class Api {
 public:
  /// `pictures`: a folder of the lab's own for what it renders and is sent. `pages`: a folder that the page's
  /// files are read from while they are worked on; empty: those in the program.
  Api(const Workspace& workspace, JobList& jobs, std::filesystem::path pictures, std::filesystem::path pages);

  /// Never throws: errors become answers with a status and {"where", "what"}.
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
