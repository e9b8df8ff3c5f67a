# The JSON report of the tests -> the table, `$form` csv or markdown. `$chart`: [chart.json or null].

def claims: {
  "1": "free beam against its closed form: 1e-8 after 2 s; order as nominal",
  "2": "undamped beam keeps its energy for 12 s; the paper's Euler scheme multiplies it by 2.513",
  "3": "10^6 random hits obey the impact law",
  "4": "bouncing ends when it must, in bounded work and time",
  "5": "energy ledger closes to 1e-8 of the work; with fixed steps at first order or better",
  "6": "held contacts stay shut, never pull and are released",
  "7": "symmetric double hit is exact and symmetric",
  "8": "mirrored trials give the same bits",
  "9": "limits of k, Rm, F and e; a stiff beam is a wall",
  "10": "time reversal through ten hits",
  "11": "10^6 near-singular starts: no NaN, no penetration",
  "12": "10^5 random scenes: no NaN, no hang; steps beyond the bound are refused",
  "13": "sd of v_x is 0.2 Rm at five steps",
  "14": "halving the step keeps the output",
  "15": "the threshold hardly matters",
  "16": "chart of speed against accuracy: methods, settings, scenes, runs",
  "17": "reference ten times better than what is plotted; nothing dropped"
};

# ---- Figures ----

def of_tests:
  [.testsuites[].testsuite[] | . as $test
   | to_entries[] | select(.key | startswith("figure_")) | .value | fromjson
   | . + {test: ($test.classname + "." + $test.name), failed: ($test | has("failures"))}];

def row($requirement; $what; $figure; $unit; $limit; $at_least):
  {requirement: $requirement, method: "all", what: $what, figure: $figure, unit: $unit,
   limit: $limit, at_least: $at_least, cases: 1, asked: 1, test: "results/accuracy/chart.json",
   failed: false,
   within: (if $limit == null then null elif $figure == null then false
            elif $at_least then $figure >= $limit else $figure <= $limit end)};

def of_chart:
  if . == null then
    [row(16; "results/accuracy/chart.json"; null; "-"; null; true),
     row(17; "results/accuracy/chart.json"; null; "-"; null; true)]
  else
    .scenes as $scenes
    | [$scenes[].settings[]] as $settings
    # How far errors shown lie above the reference's own. One trial is the least that can be seen.
    | def margins(shown; own; $least):
        [$scenes[] | . as $scene | ([own, (if $least then 1 / $scene.trials else 0 end)] | max) as $own
         | .settings[] | select(.errors) | shown | numbers | select(. > 0 and $own > 0) | . / $own]
        | min;
    [row(16; "methods"; [$settings[].method] | unique | length; "-"; 3; true),
     row(16; "settings of a method, fewest";
         [$scenes[].settings | group_by(.method)[] | length] | min; "-"; 8; true),
     row(16; "scenes"; $scenes | length; "-"; 6; true),
     row(16; "scenes in which a setting fails";
         [$scenes[] | select(any(.settings[]; .status != "ok"))] | length; "-"; 3; true),
     row(16; "timed runs after warm-up, fewest";
         [$settings[].microseconds_per_trial | values | .rounds | length] | min; "-"; 10; true),
     row(17; "least TV shown over the reference's own error";
         margins(.errors.outcomes.total_variation;
                 .reference.own_error.errors.outcomes.total_variation; true); "-"; 10; true),
     row(17; "least median distance shown over the reference's own";
         margins(.errors.strong.position_m.median;
                 .reference.own_error.errors.strong.position_m.median; false); "-"; 10; true),
     row(17; "TV of the reference against another method, largest";
         [$scenes[].reference.another_method.errors.outcomes.total_variation | numbers] | max;
         "-"; null; false),
     row(17; "settings dropped: neither error nor reason";
         [$settings[] | select((.errors or .reason) | not)] | length; "settings"; 0; false)]
  end;

# ---- Lines of the table ----

def met:
  if .failed then "no: test failed"
  elif .within == false then "no"
  elif .figure == null then "not measured"
  elif .within == null then "-"
  elif .cases < .asked then "too few cases"
  else "yes" end;

# The worst of all figures that the same words describe.
def merged:
  group_by([.requirement, .method, .what])
  | map((if .[0].at_least then min_by(.figure) else max_by(.figure) end)
        + {figure: (if any(.[]; .figure == null) then null
                    elif .[0].at_least then map(.figure) | min else map(.figure) | max end),
           within: (if .[0].limit == null then null else all(.[]; .within) end),
           failed: any(.[]; .failed),
           cases: (map(.cases) | add), asked: (map(.asked) | add),
           test: (map(.test) | unique | join(" "))}
        | . + {met: met});

# Nothing is said of these: the claim stands with no figure.
def unclaimed:
  . as $rows
  | [range(1; 16) | select(. != 3) as $r
     | ("event", "stable") as $m
     | select(all($rows[]; .requirement != $r or .method != $m))
     | {requirement: $r, method: $m, what: "", figure: null, unit: "", limit: null,
        at_least: false, cases: null, asked: null, test: "", met: "not claimed"}];

def bound: if .limit == null then "" else (if .at_least then ">= " else "<= " end) + (.limit | tostring) end;
def text: if . == null then "" else tostring end;

def summary($rows; $r; $method):
  [$rows[] | select(.requirement == $r and .method == $method and .met != "-") | .met]
  | if length == 0 then ""
    elif (unique | length) == 1 then .[0]
    else "\(map(select(. == "yes")) | length) of \(length)" end;

(of_tests + ($chart[0] | of_chart) | merged) as $measured
| [range(1; 18) | select(. as $r | all($measured[]; .requirement != $r))] as $missing
| if ($missing | length) > 0 then error("no test measured requirements \($missing)") else . end
| ($measured + ($measured | unclaimed)
   | sort_by([.requirement, (.method | {event: 0, stable: 1, contact: 2, all: 2}[.] // 3), .method]))
  as $rows
| if $form == "csv" then
    (["requirement", "claim", "method", "measured", "figure", "unit", "limit", "met", "cases",
      "cases_asked", "test"] | join(",")),
    ($rows[] | [.requirement, claims[.requirement | tostring], .method, .what, .figure, .unit,
                bound, .met, .cases, .asked, .test] | @csv)
  else
    "# Requirements 1 to 17", "",
    "Made by `results/requirements/run.sh`. \"3 of 4\": so many of the figures below are within their",
    "limits. A limit is the requirement's own; where it sets none, the figure is given as it is.", "",
    "| # | claim | event | stable | others |", "|---|---|---|---|---|",
    (range(1; 18) as $r
     | ([$rows[] | select(.requirement == $r) | .method] | unique - ["event", "stable"]
        | map(. as $m | summary($rows; $r; $m) | select(. != "") | "\($m): \(.)") | join(", "))
       as $others
     | "| \($r) | \(claims[$r | tostring]) | \(summary($rows; $r; "event")) | \(summary($rows; $r; "stable")) | \($others) |"),
    "",
    "| # | method | measured | figure | unit | limit | met | cases | test |",
    "|---|---|---|---|---|---|---|---|---|",
    ($rows[] | "| \(.requirement) | \(.method) | \(.what) | \(.figure | text) | \(.unit) | \(bound) | \(.met) | \(.cases | text)\(if .cases != null and .cases < .asked then " of \(.asked)" else "" end) | \(.test) |")
  end
