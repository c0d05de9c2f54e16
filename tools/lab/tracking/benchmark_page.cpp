#include "tools/lab/tracking/benchmark_page.h"

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "src/output/text_file.h"

namespace cgsr::lab {
namespace {

constexpr std::string_view kEnd = "</body></html>";

std::string section(const SequencePictures& pictures) {
  std::string html = fmt::format("<h3>{}</h3>\n<video controls preload=\"none\" width=\"480\" src=\"{}\"></video>\n",
                                 pictures.sequence, pictures.film);
  for (const FailurePicture& failure : pictures.failures) {
    html += fmt::format(
        "<figure style=\"display:inline-block;margin:.5em\"><img width=\"240\" loading=\"lazy\" alt=\"\" "
        "src=\"{}\"><figcaption>{}</figcaption></figure>\n",
        failure.file, failure.caption);
  }
  return html;
}

}  // namespace

Result<void> write_benchmark_page(const Report& report, const std::vector<SequencePictures>& sequences,
                                  const std::filesystem::path& folder) {
  std::string html = to_html({report});
  html.resize(html.rfind(kEnd));
  html +=
      "<h2>Sequences</h2>\n<p>Truth white, ours green; the pictures show the first image of each of its losses.</p>\n";
  for (const SequencePictures& pictures : sequences) html += section(pictures);
  html += fmt::format("{}\n", kEnd);
  return app::write_file(folder / "index.html", html);
}

}  // namespace cgsr::lab
