#include <flexcomp/client.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

/* Plays the robot controller along a path of `flexcomp plan`, in lock-step with flexcompd or, asked
   for it, in real time: bus_controller vcan0 0092596dd2483751 [real-time] <path.csv */

#define PERIOD 4000000 /* ns */

static flexcomp_client_t client;
static flexcomp_frames_t frames;
static int bus;
static bool is_real_time;

static int64_t now(void) { /* ns, a clock that only grows */
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

static void open_bus(const char* interface) {
  struct sockaddr_can address = {.can_family = AF_CAN,
                                 .can_ifindex = (int)if_nametoindex(interface)};
  bus = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  if (bus < 0 || address.can_ifindex == 0 ||
      bind(bus, (struct sockaddr*)&address, sizeof address) != 0) {
    perror(interface);
    exit(2);
  }
}

/* Sends the message in `frames`; classic frames, as this client asks for no others. */
static void send_frames(void) {
  for (size_t i = 0; i < frames.count; ++i) {
    struct can_frame frame = {.can_id = frames.frame[i].id, .can_dlc = frames.frame[i].size};
    memcpy(frame.data, frames.frame[i].data, frame.can_dlc);
    if (write(bus, &frame, sizeof frame) != (ssize_t)sizeof frame) {
      perror("send");
      exit(2);
    }
  }
}

/* Takes the frames that have come, and waits up to so long (ms) for the answer. Whether it came. */
static bool take_frames(int patience) {
  const int64_t until = now() + patience * (int64_t)1000000;
  struct pollfd input = {.fd = bus, .events = POLLIN};
  bool answered = false;
  while (poll(&input, 1, answered || now() >= until ? 0 : patience) > 0) {
    struct can_frame from;
    if (read(bus, &from, sizeof from) == (ssize_t)sizeof from) {
      flexcomp_can_frame_t frame = {.id = from.can_id, .size = from.can_dlc};
      memcpy(frame.data, from.data, sizeof from.data);
      answered |= flexcomp_client_receive(&client, &frame, now()) == FLEXCOMP_CLIENT_ANSWER;
    }
  }
  return answered;
}

/* In lock-step: until the answer is there. The first setpoints of a controller that starts anew are
   not answered: its counters do not go on. In real time: until the period is over. */
static void wait_for_next_period(void) {
  static bool is_heard;
  static int64_t next;
  if (!is_real_time) {
    is_heard |= take_frames(is_heard ? 1000 : 50);
    return;
  }
  next = (next == 0 ? now() : next) + PERIOD;
  const struct timespec time = {.tv_sec = next / 1000000000, .tv_nsec = next % 1000000000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL);
  take_frames(0);
}

/* One period: what the drives are to follow, and the last state that was heard. A lost answer ends
   nothing: the client holds the correction, and fades it out where answers cease. */
static flexcomp_state_t cycle(const double q[FLEXCOMP_JOINTS], const double wrench[6],
                              double drives[FLEXCOMP_JOINTS]) {
  static int periods;
  if (periods < 25 || periods % 50 == 0) { /* for 0.1 s of 4 ms, then every 0.2 s */
    flexcomp_client_identity(&client, &frames);
    send_frames();
  }
  ++periods;
  flexcomp_client_wrench(&client, wrench, false, now(), &frames);
  send_frames();
  flexcomp_client_setpoint(&client, q, now(), &frames);
  send_frames();
  wait_for_next_period();
  flexcomp_client_end_period(&client, q, drives);
  flexcomp_answer_t answer;
  flexcomp_client_answer(&client, &answer);
  return answer.state;
}

/* One row of the path. Whether there was one. */
static bool read_row(double q[FLEXCOMP_JOINTS], double wrench[6]) {
  char line[1024];
  double t;
  return fgets(line, sizeof line, stdin) != NULL &&
         sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t, &q[0], &q[1],
                &q[2], &q[3], &q[4], &q[5], &wrench[0], &wrench[1], &wrench[2], &wrench[3],
                &wrench[4], &wrench[5]) == 13;
}

int main(int count, char** arguments) {
  is_real_time = count == 4 && strcmp(arguments[3], "real-time") == 0;
  if (count != (is_real_time ? 4 : 3)) {
    fprintf(stderr, "usage: %s INTERFACE MODEL_HASH [real-time] <path.csv\n", arguments[0]);
    return 2;
  }
  const flexcomp_client_config_t config = {
      .fd = false,
      .model_hash = strtoull(arguments[2], NULL, 16),
      .follower = {.period = 0.004, .hold_time = 0.25, .fade_time = 0.5}};
  if (flexcomp_client_init(&client, &config) != FLEXCOMP_OK) {
    return 2;
  }
  open_bus(arguments[1]);
  double q[FLEXCOMP_JOINTS];
  double wrench[6];
  double drives[FLEXCOMP_JOINTS];
  char header[1024];
  if (fgets(header, sizeof header, stdin) == NULL || !read_row(q, wrench)) {
    fprintf(stderr, "standard input: no path\n");
    return 2;
  }

  flexcomp_command_reply_t reply = {.reply = FLEXCOMP_NOT_READY};
  for (int i = 0; i < 100 && reply.reply == FLEXCOMP_NOT_READY; ++i) {
    cycle(q, wrench, drives);
    if (i % 20 == 19) { /* after some good cycles; not ready: once more */
      flexcomp_client_command(&client, FLEXCOMP_COMMAND_ARM, &frames);
      send_frames();
      cycle(q, wrench, drives);
      flexcomp_client_reply(&client, &reply);
    }
  }
  if (reply.reply != 0 || reply.command != FLEXCOMP_COMMAND_ARM) {
    printf("not armed: %s\n", reply.command == FLEXCOMP_COMMAND_ARM
                                  ? flexcomp_describe_reply(reply.reply)
                                  : "nobody answers");
    return 1;
  }
  flexcomp_state_t state = FLEXCOMP_STATE_FADING_IN;
  for (int i = 0; i < 1000 && state != FLEXCOMP_STATE_ACTIVE; ++i) {
    state = cycle(q, wrench, drives);
  }

  double largest = 0; /* rad, that joint 2 is moved by */
  do {
    state = cycle(q, wrench, drives);
    const double moved = drives[1] > q[1] ? drives[1] - q[1] : q[1] - drives[1];
    largest = moved > largest ? moved : largest;
  } while (read_row(q, wrench) && !flexcomp_client_is_lost(&client) &&
           (state == FLEXCOMP_STATE_ACTIVE || state == FLEXCOMP_STATE_HOLDING));
  printf("%s; joint 2 was moved by up to %.0f urad\n", flexcomp_describe_state(state),
         1e6 * largest);

  flexcomp_client_command(&client, FLEXCOMP_COMMAND_DISARM, &frames);
  send_frames();
  /* 200 periods are more than the node takes to fade, and more than the client does by itself. */
  for (int i = 0; i < 200 && cycle(q, wrench, drives) != FLEXCOMP_STATE_OFF; ++i) {
  }
  close(bus);
  return state == FLEXCOMP_STATE_ACTIVE ? 0 : 1;
}
