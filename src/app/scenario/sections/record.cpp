#include "app/scenario/sections/record.h"

namespace faba {

Schema<Record> Record::schema() {
  return Schema<Record>("record", "What a run keeps beside series.csv, manifest and report")
      .add("tracks", &Record::tracks, {.doc = "tracks.h5: positions of all cells"})
      .add("tracks_every", &Record::tracks_every,
           {.min = 1, .max = 1e6, .doc = "Every how many frames tracks are kept"})
      .add("compress", &Record::compress,
           {.doc = "Compress tracks.h5 (lossless; a quarter smaller, ten times slower)"})
      .add("video", &Record::video, {.doc = "video.mp4: the swarm, for browsers"})
      .add("video_every", &Record::video_every,
           {.min = 1, .max = 1e6, .doc = "Every how many frames a picture is rendered"})
      .add("lossless", &Record::lossless, {.doc = "video.avi as well, exact to the grey level, for Fiji"})
      .add("as_seen", &Record::as_seen,
           {.doc = "Videos show what the camera sees through the microscope of [microscope], not a drawing"})
      .add("flow", &Record::flow,
           {.doc = "flow.h5: optical flow between the frames that the camera sees, made with [flow]"})
      .add("checkpoint", &Record::checkpoint,
           {.unit = "s",
            .min = 0.1,
            .max = 1e6,
            .doc = "Time on the clock between checkpoints: what a crash can cost"});
}

}  // namespace faba
