/* The firmware on a computer, behind a pseudo-terminal, with a log in place of coils:
 *   coil-firmware LINK LOG
 * creates LINK as a symbolic link to the terminal, and writes a line "time_s enable v0 v1 ..." to LOG at every change
 * of the outputs, time on CLOCK_MONOTONIC. Runs until ended by a signal. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "../coil_controller.h"

static int terminal;
static FILE* log_file;
static int32_t outputs[COIL_CHANNELS];
static int enabled;

static double now_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void write_log(void) {
  int i;
  fprintf(log_file, "%.6f %d", now_s(), enabled);
  for (i = 0; i < COIL_CHANNELS; ++i) fprintf(log_file, " %d", outputs[i]);
  fputc('\n', log_file);
  fflush(log_file);
}

static void put(int channel, int32_t microvolt) {
  if (outputs[channel] == microvolt) return;
  outputs[channel] = microvolt;
  write_log();
}

static void enable(int on) {
  if (enabled == on) return;
  enabled = on;
  write_log();
}

/* Reading of a shunt at each output. */
static int32_t sense(int channel) { return enabled ? outputs[channel] : COIL_NEUTRAL_UV; }

static void send_text(const char* text, int length) {
  while (length > 0) {
    const ssize_t n = write(terminal, text, (size_t)length);
    if (n > 0) {
      text += n;
      length -= (int)n;
    } else if (errno != EINTR) {
      return; /* not connected, or buffer full: the answer is lost, as on a wire */
    }
  }
}

int main(int argc, char** argv) {
  const struct coil_hal hal = {put, enable, sense, send_text};
  struct coil_controller c;
  struct termios raw;
  int slave;
  char name[128];
  if (argc != 3) {
    fputs("usage: coil-firmware LINK LOG\n", stderr);
    return 2;
  }
  log_file = fopen(argv[2], "w");
  cfmakeraw(&raw);
  if (!log_file || openpty(&terminal, &slave, name, NULL, NULL) != 0 || tcsetattr(slave, TCSANOW, &raw) != 0 ||
      symlink(name, argv[1]) != 0) {
    perror("coil-firmware");
    return 1;
  }
  fcntl(terminal, F_SETFL, O_NONBLOCK);
  coil_begin(&c, hal, (uint32_t)(1e3 * now_s()));
  for (;;) {
    struct pollfd ready = {terminal, POLLIN, 0};
    char bytes[256];
    ssize_t n, i;
    poll(&ready, 1, 2);
    n = read(terminal, bytes, sizeof bytes);
    for (i = 0; i < n; ++i) coil_receive(&c, bytes[i], (uint32_t)(1e3 * now_s()));
    coil_tick(&c, (uint32_t)(1e3 * now_s()));
  }
}
