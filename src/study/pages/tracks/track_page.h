#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "study/pages/run_figures.h"
#include "study/tracks/track_measurement.h"
#include "vision/image/image.h"

namespace faba {

/// The page of `faba track --report`: results of track_video(), the tracks on the first frame, the figures.
/// Self-contained.
std::string track_page(const TrackMeasurement& measured, const std::vector<Figure>& figures,
                       const RgbImage& tracks, const Provenance& provenance = {});

/// Writes tracks.svg (`paths`), speeds.svg, msd.svg and heading.svg into the folder `where`, which is created
/// when it does not exist.
void write_track_figures(const std::filesystem::path& where, const std::vector<Figure>& figures,
                         const Plot& paths);

}  // namespace faba
