#pragma once
#include "core/schema.h"

namespace faba {

/// The table [record]: files that a run records.
struct Record {
  bool tracks = true;
  int tracks_every = 1;
  double resolution_px = 0;
  bool compress = true;
  bool video = true;
  int video_every = 1;
  bool lossless = false;
  bool as_seen = false;
  bool flow = false;
  double checkpoint = 10;
  static Schema<Record> schema();
};

}  // namespace faba
