/* Settings of the board: the only file to change for another board. */
#ifndef COIL_CONFIG_H
#define COIL_CONFIG_H

#define COIL_CHANNELS 4         /* number of outputs, and of current-sensing inputs */
#define COIL_NEUTRAL_UV 2500000 /* output voltage of zero current, microvolt */
#define COIL_LEAST_UV 0         /* output range, microvolt */
#define COIL_MOST_UV 5000000
#define COIL_DEADLINE_MS 70 /* command timeout, after which the coils are de-energised */

#endif
