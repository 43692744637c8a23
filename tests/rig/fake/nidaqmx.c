/* A mock of the NI-DAQmx library: devices that only write a log. FAKE_NI_LOG is the log file, with a line
 * "time_s channel value" for each output, time on CLOCK_MONOTONIC. FAKE_NI_FAIL_AT=k makes the k-th call after the
 * start of the outputs and all later calls fail. Outputs keep their values when the process ends, like those of a
 * USB-6009: the last lines of the log remain valid. With FAKE_NI_BASE it is a mock of NI-DAQmx Base: other names, ports
 * instead of lines, and no list of devices. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef FAKE_NI_BASE
#define NI(name) DAQmxBase##name
#else
#define NI(name) DAQmx##name
#endif

enum { kMost = 16 };
struct task {
  int outputs, inputs, lines;
  char channel[kMost][64];
  double least[kMost], most[kMost], last[kMost];
};
static FILE* log_file;
static long calls, fail_at;
static double latest[kMost];
static char error_text[256] = "";

static void note(const char* channel, double value) {
  struct timespec t;
  if (!log_file) {
    const char* name = getenv("FAKE_NI_LOG");
    const char* at = getenv("FAKE_NI_FAIL_AT");
    log_file = name ? fopen(name, "a") : NULL;
    fail_at = at ? atol(at) : 0;
    if (!log_file) return;
  }
  clock_gettime(CLOCK_MONOTONIC, &t);
  fprintf(log_file, "%.6f %s %.6f\n", (double)t.tv_sec + 1e-9 * (double)t.tv_nsec, channel, value);
  fflush(log_file);
}

static int fail(int code, const char* why) {
  snprintf(error_text, sizeof error_text, "%s\nTask Name: _unnamedTask<0>", why);
  return code;
}
static int broken(void) {
  ++calls;
  return fail_at > 0 && calls >= fail_at ? fail(-200324, "The device was unplugged.") : 0;
}

int32_t NI(CreateTask)(const char* name, void** task) {
  (void)name;
  *task = calloc(1, sizeof(struct task));
  return 0;
}
int32_t NI(CreateAOVoltageChan)(void* task, const char* channel, const char* name, double least, double most,
                                 int32_t units, const char* scale) {
  struct task* t = task;
  (void)name, (void)scale;
  if (units != 10348) return fail(-200077, "Requested value is not a supported value for this property.");
  if (strncmp(channel, "Dev", 3) != 0) return fail(-200220, "Device identifier is invalid.");
  if (strncmp(channel, "Dev9", 4) == 0) return fail(-200220, "Device identifier is invalid.");
  if (least < 0 || most > 5) return fail(-200077, "Requested value is not a supported value for this property.");
  if (t->outputs > 0 && strncmp(channel, t->channel[0], 4) != 0)
    return fail(-200559, "Channels of one task must be of one device.");
  snprintf(t->channel[t->outputs], sizeof t->channel[0], "%s", channel);
  t->least[t->outputs] = least, t->most[t->outputs] = most;
  ++t->outputs;
  return 0;
}
int32_t NI(CreateAIVoltageChan)(void* task, const char* channel, const char* name, int32_t terminal, double least,
                                 double most, int32_t units, const char* scale) {
  struct task* t = task;
  (void)name, (void)terminal, (void)least, (void)most, (void)units, (void)scale;
  snprintf(t->channel[t->inputs++], sizeof t->channel[0], "%s", channel);
  return 0;
}
int32_t NI(CreateDOChan)(void* task, const char* lines, const char* name, int32_t grouping) {
  struct task* t = task;
  (void)name, (void)grouping;
  snprintf(t->channel[0], sizeof t->channel[0], "%s", lines);
  t->lines = 1;
  return 0;
}
int32_t NI(StartTask)(void* task) {
  (void)task;
  return 0;
}
int32_t NI(ClearTask)(void* task) {
  free(task);
  return 0;
}
int32_t NI(WriteAnalogF64)(void* task, int32_t samples, uint32_t start, double timeout, uint32_t layout,
                            const double* values, int32_t* written, uint32_t* reserved) {
  struct task* t = task;
  int i;
  (void)start, (void)timeout, (void)layout, (void)reserved;
  if (log_file && broken()) return -200324;
  for (i = 0; i < t->outputs; ++i) {
    if (values[i] < t->least[i] || values[i] > t->most[i]) return fail(-200077, "Generation value is out of range.");
    t->last[i] = latest[i] = values[i];
    note(t->channel[i], values[i]);
  }
  if (written) *written = samples;
  return 0;
}
int32_t NI(ReadAnalogF64)(void* task, int32_t samples, double timeout, uint32_t fill, double* values, uint32_t size,
                           int32_t* got, uint32_t* reserved) {
  struct task* t = task;
  int i;
  (void)timeout, (void)fill, (void)size, (void)reserved;
  if (broken()) return -200324;
  for (i = 0; i < t->inputs; ++i) values[i] = latest[i];
  if (got) *got = samples;
  return 0;
}
#ifdef FAKE_NI_BASE
int32_t NI(WriteDigitalU8)(
#else
int32_t NI(WriteDigitalLines)(
#endif
    void* task, int32_t samples, uint32_t start, double timeout, uint32_t layout, const uint8_t* values, int32_t* written,
    uint32_t* reserved) {
  struct task* t = task;
  (void)start, (void)timeout, (void)layout, (void)reserved;
  if (log_file && broken()) return -200324;
#ifdef FAKE_NI_BASE
  note(t->channel[0], (values[0] >> (t->channel[0][strlen(t->channel[0]) - 1] - '0')) & 1); /* the bit of the line */
#else
  note(t->channel[0], values[0]);
#endif
  if (written) *written = samples;
  return 0;
}
int32_t NI(GetExtendedErrorInfo)(char* text, uint32_t size) {
  snprintf(text, size, "%s", error_text);
  return 0;
}
#ifndef FAKE_NI_BASE
int32_t NI(GetSysDevNames)(char* text, uint32_t size) {
  snprintf(text, size, "Dev1, Dev2");
  return 0;
}
int32_t NI(GetDevProductType)(const char* device, char* text, uint32_t size) {
  (void)device;
  snprintf(text, size, "USB-6009");
  return 0;
}
#endif
