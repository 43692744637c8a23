#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {

namespace {

void add_track(CLI::App& app, CommandLine& line) {
  const auto t = std::make_shared<TrackVerb>();
  CLI::App* v =
      verb(app, line, "track", "Find and follow cells or beads in a video and measure how they move",
           "  faba track film.avi --um-per-px 0.35 --out tracks.csv --report tracks.html\n"
           "  faba track 'frames/frame_*.tif' --fps 26.87 --out tracks.h5 --overlay seen.mp4");
  v->add_option("video", t->video,
                "Video, TIFF stack, folder of pictures, pattern in quotes, or run directory")
      ->required();
  v->add_option("--fps", t->fps, "Frames per second, where the video does not state them or not truly")
      ->check(CLI::Range(1e-6, 1e7));
  v->add_option("--um-per-px", t->um_per_px, "Scale: micrometres per pixel")->check(CLI::Range(1e-6, 1e6));
  v->add_option("--out", t->out, "Write the tracks, as CSV or HDF5 by the ending; may be given twice");
  v->add_option("--overlay", t->overlay, "Write the video with the tracks drawn in, as MP4 or AVI");
  v->add_option("--report", t->report, "Write a page with figures and numbers, as HTML");
  v->add_option("--picture", t->picture, "Write the first frame with all tracks, as PNG");
  v->add_option("--figures", t->figures, "Write the figures into this folder, as SVG");
  v->add_option("--size", t->size_px, "Width of a cell at half its contrast, px; found when absent")
      ->check(CLI::Range(1.0, 60.0));
  v->add_option("--polarity", t->polarity, "Cells are dark, bright or both; found when absent")
      ->check(CLI::IsMember({"auto", "dark", "bright", "both"}));
  v->add_option("--background", t->background, "median of the video, or spatial: each frame, smoothed")
      ->check(CLI::IsMember({"auto", "median", "spatial"}));
  v->add_option("--threshold", t->threshold,
                "Least signal-to-noise of a spot; 1 false one in 10 frames when absent")
      ->check(CLI::Range(1.0, 1e6));
  v->add_option("--reach", t->reach_px, "Farthest displacement between two frames, px; found when absent")
      ->check(CLI::Range(0.1, 1e5));
  v->add_option("--motion", t->motion, "Foretell by velocity or as nearest; found when absent")
      ->check(CLI::IsMember({"auto", "nearest", "velocity"}));
  v->add_option("--memory", t->memory, "Frames in a row that a cell may be unseen")
      ->check(CLI::Range(0, 1000));
  v->add_option("--least", t->least, "Shortest track that counts, in sightings")
      ->check(CLI::Range(1, 100000));
  v->add_option("--interval", t->interval,
                "Frames over which displacements are taken for speeds and turns; found when absent")
      ->check(CLI::Range(1, 100000));
  v->add_flag("--drop", t->drop, "Find the edge of the drop and look inside it only");
  v->add_flag("--force", t->force, "Replace existing files");
  v->callback([t, &line] { line.code = track(*t, line.common); });
}

}  // namespace

void add_video_verbs(CLI::App& app, CommandLine& line) {
  const auto d = std::make_shared<DropVerb>();
  CLI::App* v =
      verb(app, line, "drop", "Find the edge of a drop in a picture or in the first frame of a video",
           "  faba drop drop.tif --overlay edge.png\n  faba drop film.avi --json");
  v->add_option("picture", d->picture, "TIFF, PNG, JPEG, PGM (8 or 16 bit) or any video")->required();
  v->add_option("--overlay", d->overlay, "Write the picture with the edge drawn in, as PNG")
      ->check(not_empty);
  v->add_flag("--force", d->force, "Replace an existing overlay");
  v->callback([d, &line] { line.code = drop(*d, line.common); });
  add_track(app, line);
}

}  // namespace faba::cli
