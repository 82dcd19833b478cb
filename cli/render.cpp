// demcal render: a frame of a run as a picture.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "cli/command.hpp"
#include "data/error.hpp"
#include "data/terminal.hpp"
#include "dem/run/picture.hpp"

namespace cli {
namespace {

struct RenderOptions {
  std::string frame, out, by = "material";
  std::vector<double> from{-1.0, -2.0, 1.2};
  int width = 1000;
};

}  // namespace

Action add_render(CLI::App& program) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "draw a frame of a run as a picture (POV-Ray)");
  command->add_option("FRAME", options->frame, "a file that demcal simulate --frames N has written")->required();
  command->add_option("--out", options->out, "the picture (default: beside the frame, as PNG)");
  command->add_option("--by", options->by, "what the spheres' colours show")
      ->check(one_of({"material", "speed", "coordination", "force"}));
  command->add_option("--from", options->from, "X,Y,Z: direction in which the camera stands; z is up")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  command->add_option("--width", options->width, "pixels; the height is seven tenths of it")
      ->check(CLI::Range(100, 8000));
  command->footer("Example: demcal render developer-results/frames/0002.vtkhdf --by speed");
  return [options] {
    const std::string png =
        options->out.empty() ? std::filesystem::path(options->frame).replace_extension(".png").string() : options->out;
    if (const std::string ending = std::filesystem::path(png).extension(); ending != ".png" && ending != ".PNG")
      throw data::InputError(data::ExitStatus::usage, {"--out", fmt::format("'{}' does not end in .png", png),
                                                       "pictures are PNG; another program converts them"});
    static const std::map<std::string, dem::ColourBy> colours{{"material", dem::ColourBy::material},
                                                              {"speed", dem::ColourBy::speed},
                                                              {"coordination", dem::ColourBy::coordination},
                                                              {"force", dem::ColourBy::force}};
    if (const auto& d = options->from; !(std::hypot(d[0], d[1], d[2]) > 0.0) || !std::isfinite(d[0] + d[1] + d[2]))
      throw data::InputError(data::ExitStatus::usage,
                             {"--from", fmt::format("{:g},{:g},{:g} is no direction", d[0], d[1], d[2]),
                              "give three finite numbers that are not all 0, like -1,-2,1.2"});
    dem::draw_frame(options->frame, png,
                    {.from = {options->from[0], options->from[1], options->from[2]},
                     .by = colours.at(options->by),
                     .width = options->width,
                     .height = options->width * 7 / 10});
    data::print_answer(png);
    return data::ExitStatus::done;
  };
}

}  // namespace cli
