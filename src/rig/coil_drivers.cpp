#include "rig/coil_driver.h"

namespace faba {

// To add a driver: write its file in drivers/, add its lines here.
void add_no_coils(CoilDriverRegistry& r);
void add_simulated_coils(CoilDriverRegistry& r);
void add_nidaqmx(CoilDriverRegistry& r);
void add_serial(CoilDriverRegistry& r);

CoilDriverRegistry builtin_coil_drivers() {
  CoilDriverRegistry r{"coil driver", "What puts current through the coils: [rig.driver]"};
  add_no_coils(r);
  add_simulated_coils(r);
  add_nidaqmx(r);
  add_serial(r);
  return r;
}

}  // namespace faba
