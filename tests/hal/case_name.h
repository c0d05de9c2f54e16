#pragma once

#include <string>

#include <gtest/gtest.h>

namespace cgsr::hal {

/// Names a parameterised test after its case.
struct CaseName {
  template <class Case>
  std::string operator()(const testing::TestParamInfo<Case>& info) const {
    return info.param.name;
  }
};

}  // namespace cgsr::hal
