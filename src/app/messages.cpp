#include "app/messages.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace tsubu::app {

namespace {
void say(const char* kind, const std::string& message) {
  fmt::print(stderr, "{}{}: {}\n", isatty(fileno(stderr)) == 1 ? "\r\033[K" : "", kind, message);
}
}  // namespace

void warn(const std::string& message) { say("warning", message); }
void complain(const std::string& message) { say("error", message); }

}  // namespace tsubu::app
