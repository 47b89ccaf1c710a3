#include "ensonify/python/unlocked.hpp"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace ensonify::python {
namespace {

/// How many of the user's functions this thread is in, one within another, each called from an Unlocked section.
thread_local int calls = 0;

[[noreturn]] void sleep_until_the_process_is_over() {
  while (true) ::pause();
}

}  // namespace

/// Of one process: how many threads compute, and how many are in a function of the user's meanwhile.
class Ending {
 public:
  /// A forked child has none of the threads that the parent counts, and makes another while it is alone.
  static Ending* of_this_process() {
    static auto* ending = new Ending;  // never freed: threads sleep while the process ends
    if (!ending->is_of_this_process()) ending = new Ending;
    return ending;
  }
  bool is_of_this_process() const { return process_ == ::getpid(); }

  /// Once the interpreter ends, all but the thread that ends it are barred from its lock.
  bool bars_this_thread() {
    const std::lock_guard alone(mutex_);
    return bars();
  }
  void count(int computing, int calling) {
    const std::lock_guard alone(mutex_);
    computing_ += computing;
    calling_ += calling;
    changed_.notify_all();
  }
  void begin_call() {
    const std::lock_guard alone(mutex_);
    if (bars()) throw std::runtime_error("the interpreter ends");
    --computing_;
    ++calling_;
  }
  void come() {
    std::unique_lock alone(mutex_);
    over_ = true;
    last_ = std::this_thread::get_id();
    const auto idle = [this] { return computing_ == 0; };
    changed_.wait(alone, idle);
    changed_.wait_for(alone, std::chrono::seconds(2), [this] { return computing_ + calling_ == 0; });
    changed_.wait(alone, idle);
  }

 private:
  bool bars() const { return over_ && last_ != std::this_thread::get_id(); }

  pid_t process_ = ::getpid();
  std::mutex mutex_;
  std::condition_variable changed_;
  int computing_ = 0;
  int calling_ = 0;
  bool over_ = false;
  std::thread::id last_;
};

Unlocked::Unlocked() : ending_(Ending::of_this_process()) {
  ending_->count(+1, calls > 0 ? -1 : 0);
  released_.emplace();
  sleep_if_barred();
}

Unlocked::~Unlocked() {
  const bool counted = ending_->is_of_this_process();
  if (counted) sleep_if_barred();
  released_.reset();
  // Only now: the end of the interpreter waits until this thread has the lock back.
  if (counted) ending_->count(-1, calls > 0 ? +1 : 0);
}

void Unlocked::sleep_if_barred() {
  if (!ending_->bars_this_thread()) return;
  ending_->count(-1, 0);
  sleep_until_the_process_is_over();
}

Locked::Locked() : ending_(Ending::of_this_process()) {
  ending_->begin_call();
  ++calls;
  locked_.emplace();
}

Locked::~Locked() {
  locked_.reset();
  --calls;
  if (ending_->is_of_this_process()) ending_->count(+1, -1);
}

void end_unlocked() {
  Ending* const ending = Ending::of_this_process();
  const py::gil_scoped_release released;
  ending->come();
}

}  // namespace ensonify::python
