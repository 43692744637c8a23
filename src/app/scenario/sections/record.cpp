#include "app/scenario/sections/record.h"

namespace faba {

Schema<Record> Record::schema() {
  return Schema<Record>("record", "Files that a run records in addition to series.csv, manifest and report")
      .add("tracks", &Record::tracks, {.doc = "tracks.h5: positions of all cells"})
      .add("tracks_every", &Record::tracks_every,
           {.min = 1, .max = 1e6, .doc = "Positions are recorded every N frames"})
      .add("resolution_px", &Record::resolution_px,
           {.unit = "px",
            .min = 0,
            .max = 16,
            .doc = "tracks.h5: positions are rounded to this, such as 0.015625, and stored as 16-bit "
                   "integers, which makes the file of a long run several times smaller; 0: exact"})
      .add("compress", &Record::compress,
           {.doc = "Compress tracks.h5, by all threads (lossless; a third to a half smaller)"})
      .add("video", &Record::video, {.doc = "video.mp4: video of the swarm, for browsers"})
      .add("video_every", &Record::video_every, {.min = 1, .max = 1e6, .doc = "Videos have every Nth frame"})
      .add("lossless", &Record::lossless, {.doc = "video.avi: lossless video, for Fiji"})
      .add("as_seen", &Record::as_seen,
           {.doc = "Videos show what the camera sees, rendered with [microscope], not a drawing"})
      .add("flow", &Record::flow,
           {.doc = "flow.h5: optical flow between camera frames, computed with [flow]"})
      .add("checkpoint", &Record::checkpoint,
           {.unit = "s",
            .min = 0.1,
            .max = 1e6,
            .doc = "Wall time between checkpoints, which wait for the end of a group of frames of video.mp4"})
      .add("from", &Record::from,
           {.unit = "s",
            .min = 0,
            .max = 1e6,
            .doc = "Simulated time of the first recorded frame: the run starts at 0 s, and its files contain "
                   "the part from here on"})
      .add("to", &Record::to,
           {.unit = "s",
            .min = 0,
            .max = 1e6,
            .doc = "Simulated time after the last recorded frame; default: the end of the run, which does "
                   "not end here"});
}

}  // namespace faba
