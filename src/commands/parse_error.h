#pragma once

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace cgsr::app {

/// Says on standard error what of a command line was not understood: the first command or option that there is not, with the nearest that there
/// is and where its help stands; else CLI11's own words. Help and version, which also end the parsing so, are printed.
/// \return the exit code: 0 for help and version, else 2.
int report_parse_error(const CLI::App& app, const CLI::ParseError& wrong, int argc, char** argv);

}  // namespace cgsr::app
