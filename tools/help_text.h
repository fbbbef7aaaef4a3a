// What --help looks like: columns, line breaks, and the text around the options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace gltf_radiosity::tools {

inline constexpr std::string_view kHelpDescription =
    "Bakes the diffuse light of a glTF 2.0 scene into its vertex colours (COLOR_0), so that every engine\n"
    "shows it lit: no lights, no lightmap and no second UV set at run time.";

inline constexpr std::string_view kHelpFooter =
    "Examples:\n"
    "  gltf-radiosity room.glb baked.glb\n"
    "      The lamps and lights of the file, everything else automatic\n"
    "  gltf-radiosity house.gltf baked.glb --sky 2000,2500,3000 --sun 40,120,80000 --quality high\n"
    "      A clear day: blue sky, and the sun 40 degrees high between +x and -z\n"
    "  gltf-radiosity hall.glb baked.glb --patch-size 0.25 --subdivide Floor=2 --exposure 0.5 --json -\n"
    "      Edges of at most 25 cm, the node Floor cut twice, a fixed exposure, the report on stdout\n"
    "  gltf-radiosity --batch levels baked --json report.json\n"
    "      Every scene of a folder\n"
    "\n"
    "How good is a bake? gltf-radiosity verify IN OUT says it: see gltf-radiosity verify --help.\n"
    "What does it look like? gltf-radiosity view OUT --html FILE makes a page that shows it.\n"
    "Other lights for a bake in a moment: gltf-radiosity relight FILE.rad OUT, see relight --help.\n"
    "To bake a file that is called verify, view or relight, write ./verify and so on.\n"
    "\n"
    "Exit codes: 0 done; 1 bad input; 2 wrong usage; 3 cannot write; 4 limit reached; 70 a bug of ours;\n"
    "130 and 143 interrupted. The output appears whole or not at all.";

inline constexpr std::string_view kVerifyDescription =
    "Says how far a baked file OUT is from the truth: a path tracer computes the light of IN at random\n"
    "places of OUT's surfaces. IN, and the options under Light, must be those of the bake.";

inline constexpr std::string_view kVerifyFooter =
    "Examples:\n"
    "  gltf-radiosity verify room.glb baked.glb\n"
    "      The error in a few numbers\n"
    "  gltf-radiosity verify room.glb baked.glb --image error.png --eye 1,1.7,4 --at 0,1,0\n"
    "      And a picture of where it is, seen from a place in the room\n"
    "  gltf-radiosity verify house.gltf baked.glb --sky 1,1,1 --max-error 0.03 --json -\n"
    "      For an asset pipeline: fails with 5 if the relative RMSE is above 3 %\n"
    "\n"
    "Exit codes: 0 done; 1 bad input; 2 wrong usage; 3 cannot write; 4 limit reached; 5 worse than\n"
    "--max-error; 70 a bug of ours; 130 and 143 interrupted.";

inline constexpr std::string_view kViewDescription =
    "Makes a page to look at a baked file OUT with, in any browser: its lights can be dimmed and dyed,\n"
    "the illuminance read in lux, and what it was before the bake be compared.";

inline constexpr std::string_view kViewFooter =
    "Examples:\n"
    "  gltf-radiosity view baked.glb --html baked.html\n"
    "      The page; open it with any browser, or send it to somebody\n"
    "  gltf-radiosity view hall.glb --html hall.html --title Hall\n"
    "      Under another name than the file's\n"
    "\n"
    "To bake a file that is called view, write ./view.\n"
    "\n"
    "Exit codes: 0 done; 1 bad input; 2 wrong usage; 3 cannot write; 4 limit reached; 70 a bug of ours;\n"
    "130 and 143 interrupted. The page appears whole or not at all.";

/// Two columns, 100 characters wide: names and types, then the description ending in the default.
class HelpFormatter : public CLI::Formatter {
 public:
  /// `usage`: what stands after the name of the command, before the options.
  explicit HelpFormatter(std::string usage = "IN OUT");

  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(std::string title, bool is_positional, std::vector<const CLI::Option*> options) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;

 private:
  std::string usage_;
};

}  // namespace gltf_radiosity::tools
