/* What the board is: the only file to change for another one. */
#ifndef COIL_CONFIG_H
#define COIL_CONFIG_H

#define COIL_CHANNELS 4         /* outputs, and inputs that tell what flows */
#define COIL_NEUTRAL_UV 2500000 /* output at which no current flows, microvolt */
#define COIL_LEAST_UV 0         /* what the outputs give */
#define COIL_MOST_UV 5000000
#define COIL_DEADLINE_MS 70 /* no good command for as long: everything to neutral */

#endif
