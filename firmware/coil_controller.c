#include "coil_controller.h"

static void deenergise(struct coil_controller* c, enum coil_state why) {
  int i;
  c->hal.enable(0); /* first: does not depend on the converter */
  for (i = 0; i < COIL_CHANNELS; ++i) c->hal.put(i, COIL_NEUTRAL_UV);
  c->state = why;
  c->ready = 0;
}

uint16_t coil_crc(const char* text, int length) {
  uint16_t crc = 0xFFFF;
  int i, bit;
  for (i = 0; i < length; ++i) {
    crc = (uint16_t)(crc ^ (uint16_t)((uint16_t)(uint8_t)text[i] << 8));
    for (bit = 0; bit < 8; ++bit)
      crc = (uint16_t)((crc & 0x8000) ? (uint16_t)(crc << 1) ^ 0x1021 : (uint16_t)(crc << 1));
  }
  return crc;
}

void coil_begin(struct coil_controller* c, struct coil_hal hal, uint32_t now_ms) {
  c->hal = hal;
  c->any = 0;
  c->number = 0;
  c->last_ms = now_ms;
  c->bad_lines = 0;
  c->length = 0;
  deenergise(c, COIL_OFF);
}

/* Parses a decimal number at *at and moves *at behind it and one space. Returns 0 if invalid or too long. */
static int number(const char** at, const char* end, int64_t* value) {
  int negative = 0, digits = 0;
  int64_t v = 0;
  const char* p = *at;
  if (p < end && *p == '-') {
    negative = 1;
    ++p;
  }
  while (p < end && *p >= '0' && *p <= '9') {
    if (++digits > 10) return 0;
    v = 10 * v + (*p++ - '0');
  }
  if (digits == 0 || (p < end && *p != ' ')) return 0;
  if (p < end) ++p;
  *at = p;
  *value = negative ? -v : v;
  return 1;
}

static int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

static char* write_number(char* to, int64_t v) {
  char digits[20];
  int n = 0;
  if (v < 0) {
    *to++ = '-';
    v = -v;
  }
  do {
    digits[n++] = (char)('0' + v % 10);
    v /= 10;
  } while (v > 0);
  while (n > 0) *to++ = digits[--n];
  return to;
}

/* "$A number state bad_lines sense0 sense1 ...*CRC" */
static void answer(struct coil_controller* c, uint32_t to_number) {
  static const char kHex[] = "0123456789ABCDEF";
  char text[40 + 12 * COIL_CHANNELS];
  char* p = text;
  uint16_t crc;
  int i;
  *p++ = '$';
  *p++ = 'A';
  *p++ = ' ';
  p = write_number(p, to_number);
  *p++ = ' ';
  p = write_number(p, c->state);
  *p++ = ' ';
  p = write_number(p, c->bad_lines);
  for (i = 0; i < COIL_CHANNELS; ++i) {
    *p++ = ' ';
    p = write_number(p, c->hal.sense(i));
  }
  crc = coil_crc(text + 1, (int)(p - text) - 1);
  *p++ = '*';
  for (i = 12; i >= 0; i -= 4) *p++ = kHex[(crc >> i) & 15];
  *p++ = '\n';
  c->hal.send(text, (int)(p - text));
}

/* Executes "S number enable v0 v1 ...". Returns 1 if it was a valid command. */
static int command(struct coil_controller* c, const char* at, const char* end, uint32_t now_ms) {
  int64_t to_number, enable, volts[COIL_CHANNELS];
  int i, in_range = 1;
  if (end - at < 2 || at[0] != 'S' || at[1] != ' ') return 0;
  at += 2;
  if (!number(&at, end, &to_number) || !number(&at, end, &enable) || enable < 0 || enable > 1) return 0;
  for (i = 0; i < COIL_CHANNELS; ++i) {
    if (!number(&at, end, &volts[i])) return 0;
    if (volts[i] < COIL_LEAST_UV || volts[i] > COIL_MOST_UV) in_range = 0;
  }
  if (at != end || to_number < 0 || to_number > 0xFFFFFFFFLL) return 0;
  /* Ignores repeated and out-of-order commands; half of all numbers are ahead. A command with enable 0 is always
   * accepted: a restarted host restarts its numbers with it. */
  if (enable && c->any && (int32_t)((uint32_t)to_number - c->number) <= 0) return 0;
  c->any = 1;
  c->number = (uint32_t)to_number;
  c->last_ms = now_ms;
  if (!enable) {
    deenergise(c, COIL_OFF);
    c->ready = 1;
  } else if (!in_range) {
    deenergise(c, COIL_RANGE);
  } else if (c->state == COIL_ON || c->ready) {
    for (i = 0; i < COIL_CHANNELS; ++i) c->hal.put(i, (int32_t)volts[i]);
    if (c->state != COIL_ON) c->hal.enable(1);
    c->state = COIL_ON;
  }
  answer(c, (uint32_t)to_number);
  return 1;
}

static void take_line(struct coil_controller* c, uint32_t now_ms) {
  const char* line = c->line;
  const int n = c->length;
  uint16_t stated = 0;
  int i;
  if (n < 7 || n > COIL_LINE || line[0] != '$' || line[n - 5] != '*') {
    ++c->bad_lines;
    return;
  }
  for (i = n - 4; i < n; ++i) {
    if (hex_digit(line[i]) < 0) {
      ++c->bad_lines;
      return;
    }
    stated = (uint16_t)(stated << 4 | hex_digit(line[i]));
  }
  if (stated != coil_crc(line + 1, n - 6) || !command(c, line + 1, line + n - 5, now_ms)) ++c->bad_lines;
}

void coil_receive(struct coil_controller* c, char byte, uint32_t now_ms) {
  if (byte == '\r') return;
  if (byte == '\n') {
    take_line(c, now_ms);
    c->length = 0;
  } else if (c->length < COIL_LINE) {
    c->line[c->length++] = byte;
  } else {
    c->length = COIL_LINE + 1;
  }
  coil_tick(c, now_ms);
}

void coil_tick(struct coil_controller* c, uint32_t now_ms) {
  if (c->state == COIL_ON && now_ms - c->last_ms > COIL_DEADLINE_MS) deenergise(c, COIL_TIMEOUT);
}
