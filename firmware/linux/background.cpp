#include "linux/background.hpp"

#include <poll.h>
#include <unistd.h>

#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "linux/complaint.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kMostJobs = 32;

void do_one(const std::function<void()>& job) {
  try {
    job();
  } catch (const std::exception& error) {
    complain(error.what());
  }
}

}  // namespace

void say_at_once(const char* text) {
  pollfd output = {STDERR_FILENO, POLLOUT, 0};
  if (poll(&output, 1, 0) == 1 && (output.revents & POLLOUT) != 0) {
    std::fputs(text, stderr);
  }
}

struct Background::Jobs {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::function<void()>> waiting;  ///< the first is being done
  bool ending = false;

  static void work(const std::shared_ptr<Jobs>& jobs) {
    std::unique_lock lock(jobs->mutex);
    while (true) {
      jobs->changed.wait(lock, [&] { return !jobs->waiting.empty() || jobs->ending; });
      if (jobs->waiting.empty()) {
        return;
      }
      std::function<void()> job = jobs->waiting.front();
      lock.unlock();
      do_one(job);
      job = nullptr;
      lock.lock();
      jobs->waiting.pop_front();
      jobs->changed.notify_all();
    }
  }
};

Background::Background() : jobs_(std::make_shared<Jobs>()) {
  std::thread([jobs = jobs_] { Jobs::work(jobs); }).detach();
}

Background::~Background() {
  const std::lock_guard lock(jobs_->mutex);
  jobs_->ending = true;
  jobs_->changed.notify_all();
}

bool Background::start(std::function<void()> job) {
  const std::lock_guard lock(jobs_->mutex);
  if (jobs_->waiting.size() == kMostJobs) {
    return false;
  }
  jobs_->waiting.push_back(std::move(job));
  jobs_->changed.notify_all();
  return true;
}

bool Background::say(const std::string& message) {
  return start([message] { complain(message); });
}

bool Background::finish(std::chrono::milliseconds patience) {
  std::unique_lock lock(jobs_->mutex);
  return jobs_->changed.wait_for(lock, patience, [this] { return jobs_->waiting.empty(); });
}

}  // namespace flexcomp
