#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <tuple>

#include "pipeline/runtime/schedule.h"
#include "pipeline/runtime/stage.h"

namespace cgsr::stages {

/// The section [stage] of a robot's file: a row of the schedule for each worker, in their order.
template <class... Workers>
struct StageRows {
  std::array<runtime::StageParameters, sizeof...(Workers)> rows{Workers::kRow...};

  /// \return the row of a worker, to read or to change.
  template <class Worker>
  [[nodiscard]] runtime::StageParameters& of() {
    constexpr std::array kIsIt{std::is_same_v<Worker, Workers>...};
    std::size_t i = 0;
    while (!kIsIt[i]) ++i;
    return rows[i];
  }

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    std::size_t i = 0;
    (visit.section(Workers::kName, self.rows[i++], Workers::kMeaning), ...);
  }
};

/// The stages of a loop, in the order in which it runs them. A stage is one name in this list, one line in the loop, and one member of its result.
/// Ours; the components of Fig. 5.1 are such stages.
template <class... Workers>
struct StageList {
  using Rows = StageRows<Workers...>;
  using Stages = std::tuple<runtime::Stage<Workers>...>;

  /// What does each stage's work. Null: the robot has none of it, and the stage's output stays the default.
  struct Parts : std::tuple<std::unique_ptr<Workers>...> {
    /// Makes the worker of a stage. \return it.
    template <class Worker, class... Arguments>
    Worker& make(Arguments&&... arguments) {
      auto& part = std::get<std::unique_ptr<Worker>>(*this);
      part = std::make_unique<Worker>(std::forward<Arguments>(arguments)...);
      return *part;
    }
    template <class Worker>
    void put(std::unique_ptr<Worker> worker) {
      std::get<std::unique_ptr<Worker>>(*this) = std::move(worker);
    }
    /// Takes the worker of a stage out, made on the spot where it needs nothing.
    template <class Worker>
    std::unique_ptr<Worker> take() {
      auto part = std::move(std::get<std::unique_ptr<Worker>>(*this));
      if constexpr (std::is_default_constructible_v<Worker>) {
        if (!part) part = std::make_unique<Worker>();
      }
      return part;
    }
    [[nodiscard]] Stages stages() { return Stages{runtime::Stage<Workers>(take<Workers>())...}; }
  };
};

}  // namespace cgsr::stages
