#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace faba {

/// Pixel size and frame rate that the software of a microscope has written into a picture.
struct PictureMetadata {
  std::optional<double> um_per_px;  ///< 0.001 to 1000; empty: not stated, not valid, or pixels not square
  double fps = 0;                   ///< frames per second; 0: not stated or not valid
  std::string ignored;              ///< which statement was ignored, and why; empty: none
};

/// Tags of a TIFF page that state a pixel size.
struct TiffDescription {
  std::string text;                           ///< ImageDescription
  double x_resolution = 0, y_resolution = 0;  ///< pixels per unit; 0: absent
};

/// Reads OME-XML (PhysicalSizeX, PhysicalSizeY, TimeIncrement with their units, of the first Pixels element),
/// or an ImageJ description: `unit`, with the pixels per unit of the resolution tags, and the frame interval
/// `finterval` with `tunit`, otherwise the playback rate `fps`. The resolution of a file without a unit of
/// ImageJ, or in inches, is a print resolution and is not used. `picture`: the TIFF file; OME-XML that only
/// names a companion file, or a file NAME.companion.ome or NAME.ome.xml beside it, is read from there.
PictureMetadata tiff_metadata(const TiffDescription& description, const std::filesystem::path& picture);

}  // namespace faba
