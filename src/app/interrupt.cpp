#include "app/interrupt.h"

#include <csignal>

namespace tsubu::app {

namespace {
volatile std::sig_atomic_t seen = 0;

extern "C" void note(int signal) {
  seen = 1;
  std::signal(signal, SIG_DFL);
}
}  // namespace

void watchForInterrupt() {
  seen = 0;
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() { return seen != 0; }

}  // namespace tsubu::app
