/// Serves the monitor's page of a compensator that corrects joint 1 by a wave of 500 µrad, and has
/// a stale wrench from the third second on; for as many seconds as it is told.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "flexcomp/compensator.hpp"
#include "monitor/page_server.hpp"
#include "monitor/view.hpp"

int main(int count, char** arguments) {
  constexpr std::int64_t kPeriod = 4'000'000;  // ns
  constexpr int kPeriodsAView = 25;
  const double seconds = count > 1 ? std::strtod(arguments[1], nullptr) : 1;
  flexcomp::monitor::PageServer server(0);
  flexcomp::monitor::LiveNode node(0, std::nullopt);
  std::printf("%s\n", server.address().c_str());
  std::fflush(stdout);
  std::int64_t now = 0;
  for (int view = 0; view < static_cast<int>(10 * seconds); ++view) {
    for (int i = 0; i < kPeriodsAView; ++i) {
      now += kPeriod;
      flexcomp::CorrectedMessage answer;
      const double time = static_cast<double>(now) / 1e9;
      answer.corrected[0] = 500e-6 * std::sin(2 * time);
      answer.status = time > 3 ? flexcomp::kWrenchStale : 0U;
      answer.state = time > 3 ? 3 : 2;
      node.take(flexcomp::SetpointMessage{}, now);
      node.take(flexcomp::WrenchMessage{0, {440, 1370 * std::cos(time), 635, 0, 3, 10.5}, false},
                now);
      node.take(answer, now + kPeriod / 10);
    }
    server.serve(to_json(node.snapshot(now + kPeriod / 2)).dump());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}
