#include "app/settings/parameters.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"
#include "tests/support/parameter_values.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <set>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::message_of;
using tests::other_value;

TEST(ParameterTable, KeysAreUniqueAndGrouped) {
  std::set<std::string> keys, sections;
  std::string section;
  for (const Parameter& parameter : parameters()) {
    EXPECT_TRUE(keys.insert(parameter.key).second) << parameter.key << " stands twice";
    const std::string own = parameter.key.substr(0, parameter.key.find('.'));
    if (own != section) {
      EXPECT_TRUE(sections.insert(own).second) << '[' << own << "] is torn apart at " << parameter.key;
    }
    section = own;
  }
}

TEST(ParameterTable, UnitsInKeysAreTheUnits) {
  for (const Parameter& parameter : parameters()) {
    for (const auto& [suffix, unit] : {std::pair{"_m", "m"}, {"_deg", "deg"}, {"_px", "px"}, {"_s", "s"}})
      EXPECT_EQ(parameter.key.ends_with(suffix), parameter.unit == unit) << parameter.key << " in '" << parameter.unit << "'";
    EXPECT_EQ(parameter.key.ends_with(".ev"), parameter.unit == "EV") << parameter.key;
  }
}

TEST(ParameterTable, EveryHelpIsASentence) {
  for (const Parameter& parameter : parameters()) {
    EXPECT_TRUE(parameter.help.ends_with('.')) << parameter.key << ": " << parameter.help;
    EXPECT_EQ(parameter.help.find('|'), std::string::npos) << parameter.key << ": breaks the reference's table";
  }
}

TEST(ParameterTable, DefaultsAreWithinTheirOwnRanges) {
  for (const Parameter& parameter : parameters()) {
    const std::string text = parameter_text(SceneSettings{}, parameter);
    if (text.empty()) continue;  // a file that has to be named
    SceneSettings settings;
    EXPECT_NO_THROW(set_parameter_from_text(settings, parameter.key, text)) << parameter.key << " = " << text;
    EXPECT_EQ(parameter_text(settings, parameter), text) << parameter.key;
  }
}

/// Two rows bound to one member, or a row that reads what another writes, would show here.
TEST(ParameterTable, EachParameterSetsItselfAndNothingElse) {
  const SceneSettings defaults;
  for (const Parameter& set : parameters()) {
    if (set.key == "object.shading") continue;  // has one value only
    SceneSettings settings;
    set_parameter_from_text(settings, set.key, other_value(set));
    for (const Parameter& seen : parameters()) {
      const std::string expected = seen.key == set.key ? other_value(set) : parameter_text(defaults, seen);
      EXPECT_EQ(parameter_text(settings, seen), expected) << seen.key << " after setting " << set.key;
    }
    EXPECT_EQ(settings.by_hand, std::set<std::string>{set.key});
  }
}

TEST(ParameterTable, EndsOfARangeAreInIt) {
  for (const Parameter& parameter : parameters()) {
    const auto* kind = std::get_if<RealKind>(&parameter.kind);
    if (!kind) continue;
    SceneSettings settings;
    EXPECT_NO_THROW(set_parameter(settings, parameter, kind->min)) << parameter.key;
    EXPECT_NO_THROW(set_parameter(settings, parameter, kind->max)) << parameter.key;
    EXPECT_THROW(set_parameter(settings, parameter, std::nextafter(kind->min, -1e300)), Error) << parameter.key;
    EXPECT_THROW(set_parameter(settings, parameter, std::nextafter(kind->max, 1e300)), Error) << parameter.key;
  }
}

/// Kinds of numbers with a scale.
struct Slider {
  Scale scale;
  double min, max, floor;
};

std::optional<Slider> slider_of(const Parameter& parameter) {
  if (const auto* real = std::get_if<RealKind>(&parameter.kind)) return Slider{real->scale, real->min, real->max, real->floor};
  if (const auto* integer = std::get_if<IntegerKind>(&parameter.kind))
    return Slider{integer->scale, static_cast<double>(integer->min), static_cast<double>(integer->max), 0};
  if (const auto* vector = std::get_if<VectorKind>(&parameter.kind)) return Slider{vector->scale, vector->min, vector->max, 0};
  return std::nullopt;
}

TEST(ParameterScale, AnglesAreDegreesAndColoursAreSharesOfLight) {
  for (const Parameter& parameter : parameters()) {
    const auto slider = slider_of(parameter);
    EXPECT_EQ(slider && slider->scale == Scale::angle, parameter.unit == "deg") << parameter.key;
    const bool may_be_color = std::holds_alternative<VectorKind>(parameter.kind) && slider->min == 0 && slider->max == 1;
    EXPECT_EQ(slider && slider->scale == Scale::color, may_be_color) << parameter.key;
  }
}

TEST(ParameterScale, ALogarithmBeginsAboveZero) {
  for (const Parameter& parameter : parameters()) {
    const auto slider = slider_of(parameter);
    if (!slider) continue;
    if (slider->scale != Scale::logarithmic) {
      EXPECT_EQ(slider->floor, 0) << parameter.key << " has a floor and no logarithm";
      continue;
    }
    EXPECT_NE(slider->min > 0, slider->floor > 0) << parameter.key << ": a floor is for ranges from 0";
    EXPECT_GT(slider->max / std::max(slider->min, slider->floor), 30) << parameter.key << " is as good on a linear slider";
  }
}

/// On a slider of a hundred steps a default is at an end or some step away from either: otherwise nothing could be set about it.
TEST(ParameterScale, DefaultsAreWithinASlidersReach) {
  for (const Parameter& parameter : parameters()) {
    const auto slider = slider_of(parameter);
    const auto value = real_from_text(parameter_text(SceneSettings{}, parameter));
    if (!slider || !value || *value == slider->min || *value == slider->max) continue;
    const auto height = [&](double x) { return slider->scale == Scale::logarithmic ? std::log(x) : x; };
    const double low = height(slider->floor > 0 ? slider->floor : slider->min);
    const double share = (height(*value) - low) / (height(slider->max) - low);
    EXPECT_GT(share, 0.01) << parameter.key;
    EXPECT_LT(share, 0.99) << parameter.key;
  }
}

struct Refusal {
  const char *key, *text, *message;
};

class RefusedText : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedText, NamesOptionValueAndWhatIsExpected) {
  const Refusal& refusal = GetParam();
  SceneSettings settings;
  EXPECT_EQ(message_of<UsageError>([&] { set_parameter_from_text(settings, refusal.key, refusal.text); }), refusal.message);
  EXPECT_FALSE(settings.is_by_hand(refusal.key));
}

INSTANTIATE_TEST_SUITE_P(
    Parameters, RefusedText,
    ::testing::Values(
        Refusal{"probe.ev", "bright", "--probe.ev is \"bright\"; expected a number from -30 to 30 EV"},
        Refusal{"probe.ev", "", "--probe.ev is \"\"; expected a number from -30 to 30 EV"},
        Refusal{"probe.ev", "nan", "--probe.ev is nan; expected a number from -30 to 30 EV"},
        Refusal{"probe.ev", "inf", "--probe.ev is inf; expected a number from -30 to 30 EV"},
        Refusal{"tag.size_m", "0", "--tag.size_m is 0; expected a number from 0.001 to 100 m"},
        Refusal{"tag.size_m", "-0.08", "--tag.size_m is -0.08; expected a number from 0.001 to 100 m"},
        Refusal{"quality.bands", "6.5", "--quality.bands is \"6.5\"; expected a whole number from 1 to 10"},
        Refusal{"quality.bands", "0", "--quality.bands is 0; expected a whole number from 1 to 10"},
        Refusal{"quality.bands", "4294967302", "--quality.bands is 4294967302; expected a whole number from 1 to 10"},
        Refusal{"glare.enabled", "yes", "--glare.enabled is \"yes\"; expected true or false"},
        Refusal{"exposure.mode", "eye", "--exposure.mode is \"eye\"; expected \"match\", \"fixed\" or \"auto\""},
        Refusal{"object.shading", "toon", "--object.shading is \"toon\"; expected \"prt\""},
        Refusal{"lens.noise", "much", "--lens.noise is \"much\"; expected \"auto\", true or false"},
        Refusal{"lens.shutter", "1.5", "--lens.shutter is 1.5; expected a number from 0 to 1"},
        Refusal{"lens.distortion", "on", "--lens.distortion is \"on\"; expected \"auto\", true or false"},
        Refusal{"receiver.albedo", "0.8", "--receiver.albedo is \"0.8\"; expected three numbers from 0 to 1"},
        Refusal{"receiver.albedo", "0,0,2", "--receiver.albedo is [0,0,2]; expected three numbers from 0 to 1"},
        Refusal{"receiver.albedo", "0,nan,0", "--receiver.albedo is [0,nan,0]; expected three numbers from 0 to 1"},
        Refusal{"probe.image", "",
                "--probe.image is \"\"; expected \"overcast\", \"studio\", \"sky\", \"sky:sun_elevation_deg=35,turbidity=3\", or "
                "the name of a file"},
        Refusal{"glare.enabld", "true", "--glare.enabld: there is no such parameter; `catchlight params` lists them"}));

TEST(ParameterFromText, UnknownFamilyNamesThoseThereAre) {
  SceneSettings settings;
  const std::string message = message_of<UsageError>([&] { set_parameter_from_text(settings, "tag.family", "tag99h1"); });
  EXPECT_THAT(message, HasSubstr("--tag.family is \"tag99h1\"; expected "));
  EXPECT_THAT(message, HasSubstr("\"tag36h11\""));
  EXPECT_THAT(message, HasSubstr("\"tag25h9\""));
}

TEST(ParameterFromText, FilesAreRelativeToTheWorkingFolder) {
  SceneSettings settings;
  settings.folder = "/scenes";
  set_parameter_from_text(settings, "probe.image", "light.exr");
  EXPECT_EQ(settings.resolve(settings.probe.image), (std::filesystem::current_path() / "light.exr").string());
}

TEST(ParameterFromText, AnApertureIsDrawnByTheProgramOrAFile) {
  SceneSettings settings;
  for (const char* name : {"blades:5", "dust", "none"}) {
    set_parameter_from_text(settings, "glare.aperture", name);
    EXPECT_EQ(settings.glare.aperture, name);
  }
  set_parameter_from_text(settings, "glare.aperture", "mine.png");
  EXPECT_EQ(settings.glare.aperture, (std::filesystem::current_path() / "mine.png").string());
}

TEST(ParameterFromText, ObjectKeysMakeTheFirstObjectAndRefuseToChooseAmongSeveral) {
  SceneSettings settings;
  set_parameter_from_text(settings, "object.mesh", "/a.glb");
  set_parameter_from_text(settings, "object.tag_from_object.scale", "2");
  ASSERT_EQ(settings.objects.size(), 1u);
  EXPECT_EQ(settings.objects[0].scale, 2);
  settings.objects.emplace_back();
  EXPECT_EQ(
      message_of<UsageError>([&] { set_parameter_from_text(settings, "object.mesh", "/b.glb"); }),
      "--object.mesh: the scene has 2 objects; change the one you mean in the scene file, or by its number: --object[0].mesh "
      "to --object[1].mesh");
}

TEST(ParameterFromText, ANumberSaysWhichObjectOrFurtherTag) {
  SceneSettings settings;
  settings.objects.resize(2);
  settings.tag.bundle.resize(3);
  set_parameter_from_text(settings, "object[1].tag_from_object.scale", "2");
  set_parameter_from_text(settings, "tag.bundle[2].tag_from_this.translation_m", "0.1,0,0");
  EXPECT_EQ(settings.objects[0].scale, 1);
  EXPECT_EQ(settings.objects[1].scale, 2);
  EXPECT_EQ(settings.tag.bundle[1].translation_m.x, 0);
  EXPECT_EQ(settings.tag.bundle[2].translation_m.x, 0.1);
}

TEST(ParameterFromText, NumberZeroIsTheOnlyOne) {
  SceneSettings settings;
  set_parameter_from_text(settings, "object[0].mesh", "/a.glb");
  set_parameter_from_text(settings, "object.tag_from_object.scale", "2");
  ASSERT_EQ(settings.objects.size(), 1u);
  EXPECT_EQ(settings.objects[0].mesh, "/a.glb");
}

TEST(ParameterFromText, ANumberThatNamesNothingIsRefused) {
  SceneSettings settings;
  settings.objects.resize(2);
  settings.tag.bundle.resize(1);
  const auto refusal = [&](const char* key, const char* text) {
    return message_of<UsageError>([&] { set_parameter_from_text(settings, key, text); });
  };
  EXPECT_EQ(refusal("object[2].mesh", "a.glb"),
            "--object[2].mesh: the scene has 2 objects, from --object[0].mesh to --object[1].mesh");
  EXPECT_EQ(refusal("tag.bundle[1].id", "3"), "--tag.bundle[1].id: the board has 1 further tag, which is --tag.bundle[0].id");
  EXPECT_EQ(refusal("object[1].tag_from_object.scale", "0"),
            "--object[1].tag_from_object.scale is 0; expected a number from 0.000001 to 1000000");
  for (const char* key : {"glare[0].enabled", "object[-1].mesh", "object[x].mesh", "object[].mesh", "object[1.mesh",
                          "object]1[.mesh", "object.mesh[1]", "tag[1].bundle.id", "object[1].mass"})
    EXPECT_EQ(refusal(key, "a"), "--" + std::string(key) + ": there is no such parameter; `catchlight params` lists them");
}

TEST(ParameterFromText, PlacingAnObjectThatAMatrixPlacesIsRefused) {
  SceneSettings settings;
  settings.objects.emplace_back().matrix = glm::dmat4(1.0);
  const auto place = [&] { set_parameter_from_text(settings, "object.tag_from_object.translation_m", "0,0,1"); };
  EXPECT_THAT(message_of<UsageError>(place), HasSubstr("the scene file places the object by a matrix"));
  EXPECT_NO_THROW(set_parameter_from_text(settings, "object.mesh", "/b.glb"));
}

TEST(ParameterTable, AnyElementOfWhatIsRepeatedIsReached) {
  SceneSettings settings;
  settings.objects.resize(3);
  settings.tag.bundle.resize(3);
  const Parameter &scale = *find_parameter("object.tag_from_object.scale"), &id = *find_parameter("tag.bundle.id");
  set_parameter(settings, scale, 2.0, 1);
  set_parameter(settings, id, std::int64_t{7}, 2);
  for (const std::size_t i : {0u, 1u, 2u}) {
    EXPECT_EQ(parameter_text(settings, scale, i), i == 1 ? "2" : "1");
    EXPECT_EQ(parameter_text(settings, id, i), i == 2 ? "7" : "0");
  }
}

TEST(ParameterReference, PageEqualsTheTable) {
  const std::string page = tests::read_text(CATCHLIGHT_SOURCE_DIR "/docs/parameters.md");
  EXPECT_TRUE(page == parameters_markdown()) << "write it anew: catchlight params --markdown > docs/parameters.md";
}

}  // namespace
}  // namespace catchlight::app
