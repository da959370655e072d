#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/node_bus.hpp"
#include "cli/number_options.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "linux/clock.hpp"
#include "model/robot.hpp"
#include "monitor/page_server.hpp"
#include "monitor/view.hpp"
#include "node/statistics.hpp"
#include "recording/bus_rows.hpp"

namespace flexcomp::cli {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns
constexpr std::int64_t kViewEvery = kSecond / 10;
constexpr double kLineEvery = 1;                   // s, where standard output is no terminal
constexpr std::int64_t kStatusTime = kSecond / 2;  // at least, for rates and latencies
constexpr auto kLastStatistic = static_cast<std::uint8_t>(
    static_cast<std::size_t>(StatisticName::latency) + LatencyHistogram::kBins - 1);

struct ViewOptions {
  NodeAddress address;
  RobotChoice model;
  std::string record;
  double seconds = 0;
  std::optional<std::uint16_t> web;  ///< port of the page; 0 for any
  bool json = false;
};

/// Set by Ctrl-C and SIGTERM: the monitor ends as if its time were over, and a recording is whole.
std::atomic<bool> is_over{false};

void end_the_view(int /*signal*/) { is_over = true; }

/// Takes what the bus brings: for the view, and for a recording if one is wanted.
class Listener {
 public:
  explicit Listener(const ViewOptions& options)
      : options_(options),
        bus_(options.address.open()),
        node_(monotonic_now(), model_of(options.model)) {}

  /// Listens until `until` (ns) or until the view is over.
  void listen(std::int64_t until) {
    Message message;
    for (std::int64_t left = until - monotonic_now(); left > 0 && !is_over;
         left = until - monotonic_now()) {
      if (bus_->receive(&message, left)) {
        const std::int64_t now = monotonic_now();
        node_.take(message, now);
        record(message, now);
      }
    }
  }

  void send(const Message& message) { bus_->send(message); }

  monitor::Snapshot snapshot() const {
    monitor::Snapshot snapshot = node_.snapshot(monotonic_now());
    const simulation::BusCounts counts = bus_->counts();
    snapshot.lost_messages = counts.lost;
    snapshot.damaged_messages = counts.damaged;
    return snapshot;
  }

  /// Writes the recording, if one is wanted.
  void write() const {
    if (!options_.record.empty()) {
      recording::write_recording(options_.record, rows_.finish(options_.record));
    }
  }

 private:
  static std::optional<RobotModel<double, 6>> model_of(const RobotChoice& choice) {
    return choice.empty() ? std::nullopt : std::optional(model::six_axis_model(load_robot(choice)));
  }

  void record(const Message& message, std::int64_t now) {
    if (options_.record.empty()) {
      return;
    }
    rows_.take(message);
    const auto* setpoint = std::get_if<SetpointMessage>(&message);
    if (setpoint != nullptr && rows_.is_after_last(now)) {
      rows_.end_row(now, setpoint->q);
    }
  }

  const ViewOptions& options_;
  std::unique_ptr<simulation::PlantBus> bus_;
  monitor::LiveNode node_;
  recording::BusRows rows_;
};

/// Serves the page, if one is wanted.
class Page {
 public:
  explicit Page(const ViewOptions& options) {
    if (options.web) {
      server_.emplace(*options.web);
    }
  }

  /// A line that says where it is; empty without one.
  std::string where() const {
    return server_ ? fmt::format("page        {}\n", server_->address()) : std::string();
  }

  void show(const monitor::Snapshot& snapshot) {
    if (server_) {
      server_->serve(monitor::to_json(snapshot).dump());
    }
  }

 private:
  std::optional<monitor::PageServer> server_;
};

/// Clears a terminal for the view and gives it back as it was, with the last view in it.
class Screen {
 public:
  /// `footer`: a line below each view, or empty. It goes to standard error where JSON is printed.
  Screen(bool json, std::string footer)
      : is_terminal_(!json && ::isatty(STDOUT_FILENO) == 1),
        json_(json),
        footer_(std::move(footer)) {
    if (json_) {
      fmt::print(stderr, "{}", footer_);
    }
    if (is_terminal_) {
      fmt::print("\033[2J\033[?25l");
    }
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen() {
    if (is_terminal_) {
      fmt::print("\033[?25h");
      std::fflush(stdout);
    }
  }

  /// Shows the view, where it is not too early for the next.
  void show(const monitor::Snapshot& snapshot) {
    const bool is_due = json_ || is_terminal_ || snapshot.time >= next_;
    if (!is_due) {
      return;
    }
    next_ = snapshot.time + kLineEvery;
    if (json_) {
      fmt::print("{}\n", monitor::to_json(snapshot).dump());
    } else if (is_terminal_) {
      show_on_terminal(monitor::view(snapshot) + footer_);
    } else {
      fmt::print("{}{}\n", monitor::view(snapshot), footer_);
    }
    std::fflush(stdout);
  }

 private:
  /// Over the view before, each line cleared to its end: nothing flickers.
  static void show_on_terminal(const std::string& view) {
    std::string text = "\033[H";
    for (const char c : view) {
      text += c == '\n' ? "\033[K\n" : std::string(1, c);
    }
    fmt::print("{}\033[J", text);
  }

  bool is_terminal_;
  bool json_;
  std::string footer_;
  double next_ = 0;  ///< s
};

int status(const ViewOptions& options) {
  Listener listener(options);
  const std::int64_t patience = monotonic_now() + kSecond;
  listener.listen(monotonic_now() + kStatusTime);
  while (!listener.snapshot().heartbeat && monotonic_now() < patience) {
    listener.listen(std::min(patience, monotonic_now() + kViewEvery));
  }
  if (!listener.snapshot().is_heard) {
    throw InputError(options.address.bus + ": nobody answers");
  }
  listener.send(CommandMessage{Command::report});
  const std::int64_t until = monotonic_now() + kSecond;
  while (listener.snapshot().statistics.count(kLastStatistic) == 0 && monotonic_now() < until) {
    listener.listen(std::min(until, monotonic_now() + kViewEvery));
  }
  const monitor::Snapshot snapshot = listener.snapshot();
  if (options.json) {
    fmt::print("{}\n", monitor::to_json(snapshot).dump(2));
  } else {
    fmt::print("{}", monitor::view(snapshot));
  }
  return snapshot.faults.empty() && snapshot.latched.empty() ? kDone : kDoesNotHold;
}

int watch(const ViewOptions& options) {
  Listener listener(options);
  Page page(options);
  std::signal(SIGINT, end_the_view);
  std::signal(SIGTERM, end_the_view);
  const std::int64_t began = monotonic_now();
  const auto until = options.seconds > 0 ? began + static_cast<std::int64_t>(1e9 * options.seconds)
                                         : std::numeric_limits<std::int64_t>::max();
  {
    Screen screen(options.json, page.where());
    for (std::int64_t next = began; !is_over && monotonic_now() < until;) {
      next = std::max(next + kViewEvery, monotonic_now());
      listener.listen(std::min(next, until));
      const monitor::Snapshot snapshot = listener.snapshot();
      screen.show(snapshot);
      page.show(snapshot);
    }
  }
  listener.write();
  return kDone;
}

}  // namespace

void add_node_views(CLI::App* node, Action* action) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* one = node->add_subcommand(
      "status",
      "How it is: state, faults in words, corrections, latency, what was lost. Asks it for its\n"
      "statistics. Exit code 1 while there is a fault or it is latched.");
  CLI::App* live = node->add_subcommand(
      "monitor",
      "The same ten times a second, until Ctrl-C. Only listens: it sends nothing. Where standard\n"
      "output is no terminal, once a second.\n"
      "Example: flexcomp node monitor --bus can:can0 --record run.csv");
  for (CLI::App* command : {one, live}) {
    add_bus(command, &options->address);
    add_robot(command, &options->model)
        ->description("robot.yaml, for the deflection that the wrench on the bus makes");
    command->add_flag("--json", options->json, "print JSON; the monitor an object a line");
  }
  live->add_option("--record", options->record,
                   "recording to write at the end: a row a setpoint, with what else the bus says");
  live->add_option("--web", options->web,
                   "port on this machine for a page with moving plots; 0: one that is free");
  live->add_option("--seconds", options->seconds, "s, after which it ends; 0: at Ctrl-C")
      ->check(zero_or_above());
  one->callback([=] { *action = [=] { return status(*options); }; });
  live->callback([=] { *action = [=] { return watch(*options); }; });
}

}  // namespace flexcomp::cli
