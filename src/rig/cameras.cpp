#include "rig/camera.h"

namespace faba {

// To add a camera: write its file in drivers/, add its lines here.
void add_simulated_camera(CameraRegistry& r);
void add_playback(CameraRegistry& r);
void add_opencv(CameraRegistry& r);

CameraRegistry builtin_cameras() {
  CameraRegistry r{"camera", "Where the bench's pictures come from: [rig.camera]"};
  add_simulated_camera(r);
  add_playback(r);
  add_opencv(r);
  return r;
}

}  // namespace faba
