/* Board-independent firmware of a coil driver: receives lines byte by byte, and writes outputs and answers
 * through the functions of coil_hal. docs/formats/coil-serial.md describes the protocol. C99, no heap, only
 * <stdint.h>.
 *
 * The coils are de-energised at the start. A command with enable 1 is executed only after one with enable 0
 * since the start, or since the coils were de-energised by a fault: current never returns without a new
 * request. */
#ifndef COIL_CONTROLLER_H
#define COIL_CONTROLLER_H

#include <stdint.h>

#include "coil_config.h"

#define COIL_LINE 160 /* maximum line length, characters */

/* State; sent with every answer. */
enum coil_state {
  COIL_OFF = 0,     /* de-energised: initial state, or enable 0 */
  COIL_ON = 1,      /* executes commands */
  COIL_TIMEOUT = 2, /* de-energised: command timeout */
  COIL_RANGE = 3    /* de-energised: command out of the output range */
};

/* Functions of the board. */
struct coil_hal {
  void (*put)(int channel, int32_t microvolt); /* an analogue output */
  void (*enable)(int on);                      /* enable line of the relay or of the amplifiers */
  int32_t (*sense)(int channel);               /* an analogue input, microvolt */
  void (*send)(const char* text, int length);  /* to the host */
};

struct coil_controller {
  struct coil_hal hal;
  enum coil_state state;
  int ready;          /* a command with enable 0 was received since the coils were de-energised */
  int any;            /* a valid command was received */
  uint32_t number;    /* number of the last valid command */
  uint32_t last_ms;   /* time of the last valid command */
  uint32_t bad_lines; /* number of invalid lines */
  char line[COIL_LINE];
  int length; /* received characters of the line; above COIL_LINE if it is too long */
};

void coil_begin(struct coil_controller* c, struct coil_hal hal, uint32_t now_ms);
void coil_receive(struct coil_controller* c, char byte, uint32_t now_ms);
/* Must be called every few milliseconds. */
void coil_tick(struct coil_controller* c, uint32_t now_ms);

/* CRC-16 with polynomial 0x1021 and initial value 0xFFFF. */
uint16_t coil_crc(const char* text, int length);

#endif
