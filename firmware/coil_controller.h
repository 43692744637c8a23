/* A coil driver's firmware without the board: lines come in byte by byte, outputs and answers go out through
 * the functions of coil_hal. docs/formats/coil-serial.md describes the lines. C99, no heap, no library but
 * <stdint.h>.
 *
 * It begins at rest. A command with enable 1 is obeyed only after one with enable 0 since the beginning, or
 * since it went to rest by itself: current never comes back without being asked for anew. */
#ifndef COIL_CONTROLLER_H
#define COIL_CONTROLLER_H

#include <stdint.h>

#include "coil_config.h"

#define COIL_LINE 160 /* longest line, letters */

/* Why it is at rest; sent with every answer. */
enum coil_state {
  COIL_REST = 0,    /* as it begins, or told so */
  COIL_ON = 1,      /* obeys */
  COIL_SILENCE = 2, /* no good command came in time */
  COIL_RANGE = 3    /* a command asked for what the outputs do not give */
};

/* The board. Filled in by whoever builds for one. */
struct coil_hal {
  void (*put)(int channel, int32_t microvolt); /* an analogue output */
  void (*enable)(int on);                      /* the line of the relay or of the amplifiers' enable inputs */
  int32_t (*sense)(int channel);               /* an analogue input, microvolt */
  void (*send)(const char* text, int length);  /* to the host */
};

struct coil_controller {
  struct coil_hal hal;
  enum coil_state state;
  int ready;          /* a command with enable 0 has come since it went to rest */
  int any;            /* a good command has come at all */
  uint32_t number;    /* of the last good command */
  uint32_t last_ms;   /* when that came */
  uint32_t bad_lines; /* that were not understood */
  char line[COIL_LINE];
  int length; /* of what has come of a line; beyond COIL_LINE for one that is too long */
};

void coil_begin(struct coil_controller* c, struct coil_hal hal, uint32_t now_ms);
void coil_receive(struct coil_controller* c, char byte, uint32_t now_ms);
/* To be called every few milliseconds. */
void coil_tick(struct coil_controller* c, uint32_t now_ms);

/* CRC-16 with polynomial 0x1021 and beginning 0xFFFF. */
uint16_t coil_crc(const char* text, int length);

#endif
