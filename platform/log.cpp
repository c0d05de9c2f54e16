#include "platform/log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace cgsr {
namespace {

constexpr std::array<std::pair<std::string_view, spdlog::level::level_enum>, 6> kLevels{{
    {"trace", spdlog::level::trace},
    {"debug", spdlog::level::debug},
    {"info", spdlog::level::info},
    {"warning", spdlog::level::warn},
    {"error", spdlog::level::err},
    {"off", spdlog::level::off},
}};

}  // namespace

Result<void> set_up_log(std::string_view level) {
  const auto* const found =
      std::find_if(kLevels.begin(), kLevels.end(), [&](const auto& known) { return known.first == level; });
  if (found == kLevels.end()) {
    return fail(fmt::format("log level '{}' is not one of trace, debug, info, warning, error, off", level));
  }
  auto logger = std::make_shared<spdlog::logger>("cgsr", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
  logger->set_level(found->second);
  logger->flush_on(spdlog::level::warn);
  spdlog::set_default_logger(std::move(logger));
  return {};
}

}  // namespace cgsr
