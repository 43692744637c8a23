#pragma once
#include <filesystem>

#include "app/scenario/parts.h"
#include "server/api/routes.h"
#include "server/bench/bench_console.h"
#include "server/experiments/experiment_store.h"
#include "server/experiments/imports.h"
#include "server/files/trash.h"
#include "server/jobs/job_list.h"
#include "server/runs/run_catalogue.h"
#include "server/workspace.h"

namespace faba {

/// What the handlers of requests share.
struct LabServices {
  const Workspace& workspace;
  JobList& jobs;
  /// A private folder for rendered images and uploads, removed when the lab ends.
  std::filesystem::path pictures;
  const Parts& parts;
  BenchConsole& bench;
  ExperimentStore& experiments;
  Imports& imports;
  RunCatalogue& runs;
  Trash& trash;
};

/// A deletion as the pages see it: "id", "name" and "bytes".
Json trash_item_json(const Trash::Item& item);

// Each adds the requests of one concept; see web/protocol.md. The services must outlive the routes.
void add_bench_routes(Routes& routes, const LabServices& lab);
void add_coil_routes(Routes& routes, const LabServices& lab);
void add_experiment_routes(Routes& routes, const LabServices& lab);
void add_folder_routes(Routes& routes, const LabServices& lab);
void add_gallery_routes(Routes& routes, const LabServices& lab);
void add_job_routes(Routes& routes, const LabServices& lab);
void add_input_routes(Routes& routes, const LabServices& lab);
void add_optics_routes(Routes& routes);
void add_result_routes(Routes& routes, const LabServices& lab);
void add_run_routes(Routes& routes, const LabServices& lab);
void add_scenario_routes(Routes& routes, const LabServices& lab);
void add_track_routes(Routes& routes, const LabServices& lab);
void add_trash_routes(Routes& routes, const LabServices& lab);
void add_upload_routes(Routes& routes, const LabServices& lab);
void add_video_routes(Routes& routes, const LabServices& lab);

}  // namespace faba
