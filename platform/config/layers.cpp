#include "platform/config/layers.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "platform/config/tree.h"

namespace cgsr::config {
namespace {

namespace fs = std::filesystem;

/// The `extends` of a document.
struct Extends {
  std::string text;
  std::string where;  ///< "robot.toml:2: extends = \"base.toml\""
};

/// \return the `extends` of a document, with an empty text when there is none.
Result<Extends> extends_of(const Document& document) {
  const toml::node* node = document.tree().root.get("extends");
  if (node == nullptr) return Extends{};
  const std::string where =
      fmt::format("{}:{}: extends = {}", document.name(), node->source().begin.line, one_line(*node));
  const auto text = node->value_exact<std::string>();
  if (!text || text->empty()) return fail(where + ": expected the name of a file, as a text");
  return Extends{*text, where};
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code trouble;
  return fs::equivalent(a, b, trouble) && !trouble;
}

/// "a.toml -> b.toml -> a.toml"
std::string cycle_text(const std::vector<Layers::Layer>& layers, std::size_t first, const fs::path& again) {
  std::string text;
  for (std::size_t i = first; i < layers.size(); ++i) text += layers[i].document.name() + " -> ";
  return text + again.string();
}

}  // namespace

Layers::Layers(Document document) {
  layers_.push_back({std::move(document), {}});
}

Result<Layers> Layers::load(const fs::path& file) {
  auto first = Document::load(file);
  if (!first) return tl::unexpected(first.error());
  Layers layers(std::move(*first));
  layers.may_extend_ = true;
  auto& chain = layers.layers_;
  while (true) {
    const auto extends = extends_of(chain.back().document);
    if (!extends) return tl::unexpected(extends.error());
    if (extends->text.empty()) return layers;
    const fs::path next = path_beside(chain.back().document.name(), extends->text);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (!same_file(chain[i].document.name(), next)) continue;
      return fail(
          fmt::format("{}: the files extend each other in a cycle: {}", extends->where, cycle_text(chain, i, next)));
    }
    if (chain.size() == kMaxLayers)
      return fail(fmt::format("{}: more than {} files extend each other", extends->where, kMaxLayers));
    auto document = Document::load(next);
    if (!document) return fail(fmt::format("{}\n{}", document.error().message, extends->where));
    const fs::path folder = (chain.back().folder / fs::path(extends->text).parent_path()).lexically_normal();
    chain.push_back({std::move(*document), folder});
  }
}

}  // namespace cgsr::config
