"""Checks a job template against Open Job Description's Template Schemas, version 2023-09.

Covers the parts of the specification that vdbeam's templates use (with the extension
TASK_CHUNKING); anything else is refused as unknown, so a template that passes uses nothing that was
not checked. Section numbers are those of the specification.
"""
import re
import unicodedata

IDENTIFIER = r"[A-Za-z_][A-Za-z0-9_]{0,63}"
AMOUNT = re.compile(rf"(?i:({IDENTIFIER}:)?amount(\.{IDENTIFIER})+)")
ATTRIBUTE = re.compile(rf"(?i:({IDENTIFIER}:)?attr(\.{IDENTIFIER})+)")
KNOWN_CAPABILITIES = {
    "amount": {"vcpu", "memory", "gpu", "gpu.memory", "disk.scratch"},
    "attr": {"os.family", "cpu.arch"}}
RANGE_PART = re.compile(r"\s*(-?\d+)(?:\s*-\s*(-?\d+)(?:\s*:\s*(-?\d+))?)?\s*")
REFERENCE = re.compile(rf"\s*({IDENTIFIER}(?:\.{IDENTIFIER})*)\s*")
STEP_VALUES = {"Session.WorkingDirectory", "Session.HasPathMappingRules",
               "Session.PathMappingRulesFile"}


class Invalid(Exception):
    """The template breaks a rule; the text says where and which."""


def need(condition, where, rule):
    if not condition:
        raise Invalid(f"{where}: {rule}")


def check_object(value, where, required, optional=()):
    need(isinstance(value, dict), where, "must be an object")
    for key in required:
        need(key in value, where, f"lacks {key}")
    for key in value:
        need(key in required or key in optional, where, f"unknown key {key}")


def check_list(value, where, least=1, most=None):
    need(isinstance(value, list), where, "must be a list")
    need(len(value) >= least, where, f"must have at least {least} elements")
    need(most is None or len(value) <= most, where, f"must have at most {most} elements")


def check_text(value, where, least, most, allow="", any_character=False):
    need(isinstance(value, str), where, "must be a string")
    need(len(value) >= least, where, f"must have at least {least} characters")
    need(most is None or len(value) <= most, where, f"must have at most {most} characters")
    if not any_character:
        need(all(unicodedata.category(c) != "Cc" or c in allow for c in value), where,
             "holds a control character")


def check_identifier(value, where):
    need(isinstance(value, str) and re.fullmatch(IDENTIFIER, value), where, "is not an identifier")


def check_description(json, where):
    if "description" in json:
        check_text(json["description"], f"{where}.description", 1, 2048, allow="\n\r\t")


def is_integer(value):
    return isinstance(value, int) and not isinstance(value, bool)


def integer_of(value, where):
    """The number of an <integer> or <intstring>."""
    if isinstance(value, str) and re.fullmatch(r"-?\d+", value):
        return int(value)
    need(is_integer(value), where, "must be an integer")
    return value


def references(text, where):
    """Names that a format string refers to (7.3)."""
    names, rest = [], text
    while "{{" in rest:
        before, _, rest = rest.partition("{{")
        need("}}" not in before, where, "}} without {{")
        inner, closing, rest = rest.partition("}}")
        need(closing, where, "{{ without }}")
        match = REFERENCE.fullmatch(inner)
        need(match, where, f"{{{{{inner}}}}} is not a name")
        names.append(match.group(1))
    need("}}" not in rest, where, "}} without {{")
    return names


def check_format(text, where, known, least=1, most=None, any_character=False):
    check_text(text, where, least, most, any_character=any_character)
    for name in references(text, where):
        need(name in known, where, f"{{{{{name}}}}} does not exist here")


def resolve(text, values):
    """A format string with the values of parameters in place."""
    return re.sub(r"\{\{\s*([\w.]+)\s*\}\}", lambda m: str(values[m.group(1)]), text)


def range_values(text, where):
    """Numbers of an <IntRangeExpr> (3.4.1.1.1), in increasing order."""
    spans, values = [], []
    for part in text.split(","):
        match = RANGE_PART.fullmatch(part)
        need(match, where, f"\"{part}\" is not a range")
        first = int(match.group(1))
        last = int(match.group(2)) if match.group(2) else first
        step = int(match.group(3) or 1)
        need(step != 0, where, "a range's step is not 0")
        numbers = list(range(first, last + (1 if step > 0 else -1), step)) or [first]
        span = (min(first, last), max(first, last))
        need(all(span[1] < low or high < span[0] for low, high in spans), where, "ranges overlap")
        spans.append(span)
        values += numbers
    return sorted(values)


# Section 2: job parameters.

def check_parameter(json, where):
    kind = json.get("type") if isinstance(json, dict) else None
    optional = {
        "STRING": ["description", "default", "allowedValues", "minLength", "maxLength"],
        "PATH": ["description", "default", "allowedValues", "minLength", "maxLength", "objectType",
                 "dataFlow"],
        "INT": ["description", "default", "allowedValues", "minValue", "maxValue"]}.get(kind)
    need(optional is not None, where, f"unknown type {kind}")
    check_object(json, where, ["name", "type"], optional)
    check_identifier(json["name"], f"{where}.name")
    check_description(json, where)
    if kind == "INT":
        check_int_parameter(json, where)
    else:
        check_string_parameter(json, where)
    if kind == "PATH":
        need(json.get("objectType", "FILE") in ("FILE", "DIRECTORY"), where, "bad objectType")
        need(json.get("dataFlow", "IN") in ("NONE", "IN", "OUT", "INOUT"), where, "bad dataFlow")
        # How Jobs Are Constructed: a default path is joined to the template's folder.
        need(not str(json.get("default", "")).startswith("/"), where, "default must be relative")


def check_int_parameter(json, where):
    low = integer_of(json.get("minValue", -2**63), f"{where}.minValue")
    high = integer_of(json.get("maxValue", 2**63 - 1), f"{where}.maxValue")
    need(low <= high, where, "minValue is above maxValue")
    values = json.get("allowedValues", [0])
    check_list(values, f"{where}.allowedValues")
    allowed = [integer_of(value, f"{where}.allowedValues") for value in values]
    if "default" in json:
        default = integer_of(json["default"], f"{where}.default")
        need(low <= default <= high, where, "default is out of range")
        need("allowedValues" not in json or default in allowed, where, "default is not allowed")


def check_string_parameter(json, where):
    for key in ("minLength", "maxLength"):
        need(key not in json or (is_integer(json[key]) and json[key] >= 0), where, f"bad {key}")
    low, high = json.get("minLength", 0), json.get("maxLength", 1024)
    need(low <= high, where, "minLength is above maxLength")
    check_list(json.get("allowedValues", [""]), f"{where}.allowedValues")
    for value in [*json.get("allowedValues", []), *([json["default"]] if "default" in json else [])]:
        check_text(value, where, 0, 1024, any_character=True)
        need(low <= len(value) <= high, where, "a value breaks minLength or maxLength")
    if "default" in json and "allowedValues" in json:
        need(json["default"] in json["allowedValues"], where, "default is not allowed")


# Section 3: steps.

def check_requirements(json, where, known):
    check_object(json, where, [], ["amounts", "attributes"])
    need(json, where, "must have amounts or attributes")
    names = []
    for i, amount in enumerate(json.get("amounts", [])):
        at = f"{where}.amounts[{i}]"
        check_object(amount, at, ["name"], ["min", "max"])
        check_capability(amount["name"], at, "amount", AMOUNT)
        need("min" in amount or "max" in amount, at, "lacks min or max")
        numbers = [amount.get("min", 0), amount.get("max", float("inf"))]
        need(all(isinstance(n, (int, float)) and not isinstance(n, bool) for n in numbers), at,
             "min and max are numbers")
        need(0 <= numbers[0] <= numbers[1] and numbers[1] > 0, at, "min or max out of range")
        names.append(amount["name"].lower())
    for i, attribute in enumerate(json.get("attributes", [])):
        at = f"{where}.attributes[{i}]"
        check_object(attribute, at, ["name"], ["anyOf", "allOf"])
        check_capability(attribute["name"], at, "attr", ATTRIBUTE)
        need("anyOf" in attribute or "allOf" in attribute, at, "lacks anyOf or allOf")
        for values in (attribute[k] for k in ("anyOf", "allOf") if k in attribute):
            check_list(values, at, 1, 50)
            for value in values:
                check_format(value, at, known, most=100)
                need(references(value, at) or re.fullmatch(r"[A-Za-z_][A-Za-z0-9_-]*", value), at,
                     "bad value")
        names.append(attribute["name"].lower())
    need(0 < len(names) <= 50, where, "must have 1 to 50 requirements")
    need(len(set(names)) == len(names), where, "names a capability twice")


def check_capability(name, where, kind, pattern):
    check_text(name, where, 1, 100)
    need(pattern.fullmatch(name), where, f"{name} is not a capability's name")
    parts = name.lower().split(".")
    if ":" not in parts[0] and parts[1] in ("worker", "job", "step", "task"):
        need(parts[1] == "worker" and ".".join(parts[2:]) in KNOWN_CAPABILITIES[kind], where,
             f"{name} is a reserved name")


def check_parameter_space(json, where, known, defaults, extensions):
    """Returns the names of the task parameters."""
    check_object(json, where, ["taskParameterDefinitions"])
    definitions = json["taskParameterDefinitions"]
    check_list(definitions, where, 1, 16)
    kinds = [d.get("type") for d in definitions]
    need(kinds.count("CHUNK[INT]") <= 1, where, "has more than one CHUNK[INT]")
    for i, definition in enumerate(definitions):
        at = f"{where}.taskParameterDefinitions[{i}]"
        chunked = definition.get("type") == "CHUNK[INT]"
        need(chunked or definition.get("type") == "INT", at, "unknown type")
        need(not chunked or "TASK_CHUNKING" in extensions, at, "needs the extension TASK_CHUNKING")
        check_object(definition, at, ["name", "type", "range"] + (["chunks"] if chunked else []))
        check_identifier(definition["name"], f"{at}.name")
        check_range(definition["range"], f"{at}.range", known, defaults)
        if chunked:
            check_chunks(definition["chunks"], f"{at}.chunks", known, defaults)
    names = [definition["name"] for definition in definitions]
    need(len(set(names)) == len(names), where, "names a task parameter twice")
    return names


def check_range(value, where, known, defaults):
    if isinstance(value, list):
        check_list(value, where, 1, 1024)
        for element in value:
            integer_of(element, where)
        return
    check_format(value, where, known)
    if all(name in defaults for name in references(value, where)):
        range_values(resolve(value, defaults), where)


def check_chunks(json, where, known, defaults):
    check_object(json, where, ["defaultTaskCount", "rangeConstraint"], ["targetRuntimeSeconds"])
    need(json["rangeConstraint"] in ("CONTIGUOUS", "NONCONTIGUOUS"), where, "bad rangeConstraint")
    for key, least in (("defaultTaskCount", 1), ("targetRuntimeSeconds", 0)):
        value = json.get(key, least)
        if isinstance(value, str):
            check_format(value, f"{where}.{key}", known)
            if not all(name in defaults for name in references(value, where)):
                continue
            value = resolve(value, defaults)
        need(integer_of(value, f"{where}.{key}") >= least, where, f"{key} must be at least {least}")


def check_action(json, where, known):
    check_object(json, where, ["command"], ["args", "timeout", "cancelation"])
    check_format(json["command"], f"{where}.command", known)
    for i, word in enumerate(json.get("args", [])):
        check_format(word, f"{where}.args[{i}]", known, least=0)
    if "timeout" in json:
        need(is_integer(json["timeout"]) and json["timeout"] > 0, where, "bad timeout")
    if "cancelation" in json:
        cancelation = json["cancelation"]
        notify = isinstance(cancelation, dict) and cancelation.get("mode") == "NOTIFY_THEN_TERMINATE"
        need(notify or cancelation == {"mode": "TERMINATE"}, where, "bad cancelation")
        if notify:
            check_object(cancelation, where, ["mode"], ["notifyPeriodInSeconds"])
            period = cancelation.get("notifyPeriodInSeconds", 120)
            need(is_integer(period) and 0 < period <= 600, where, "bad notifyPeriodInSeconds")


def check_step(json, where, known, defaults, extensions):
    check_object(json, where, ["name", "script"],
                 ["description", "dependencies", "hostRequirements", "parameterSpace"])
    check_text(json["name"], f"{where}.name", 1, 64)
    check_description(json, where)
    everywhere = {name for name in known if not known[name]}
    if "hostRequirements" in json:
        check_requirements(json["hostRequirements"], f"{where}.hostRequirements", everywhere)
    tasks = []
    if "parameterSpace" in json:
        tasks = check_parameter_space(json["parameterSpace"], f"{where}.parameterSpace", everywhere,
                                      defaults, extensions)
    here = set(known) | STEP_VALUES
    here |= {f"Task.{kind}.{name}" for kind in ("Param", "RawParam") for name in tasks}
    script = json["script"]
    check_object(script, f"{where}.script", ["actions"])
    check_object(script["actions"], f"{where}.script.actions", ["onRun"])
    check_action(script["actions"]["onRun"], f"{where}.script.actions.onRun", here)


def check_dependencies(steps):
    """Every dependency is another step, and none depends on itself, directly or not (3.2)."""
    waits = {}
    for step in steps:
        names = step.get("dependencies", [{"dependsOn": None}])
        check_list(names, step["name"])
        for name in names:
            check_object(name, step["name"], ["dependsOn"])
        waits[step["name"]] = {name["dependsOn"] for name in names} - {None}
    while waits:
        ready = {name for name, others in waits.items() if not others & waits.keys()}
        need(ready, "steps", "depend on each other in a circle")
        for name in ready:
            need(waits[name] <= {step["name"] for step in steps}, name, "depends on no step")
            del waits[name]


def check_template(json):
    """Raises Invalid where `json`, an object read from a template, breaks a rule."""
    check_object(json, "template", ["specificationVersion", "name", "steps"],
                 ["$schema", "extensions", "description", "parameterDefinitions"])
    need(json["specificationVersion"] == "jobtemplate-2023-09", "specificationVersion",
         "must be jobtemplate-2023-09")
    extensions = json.get("extensions", ["TASK_CHUNKING"])
    check_list(extensions, "extensions")
    need(extensions == ["TASK_CHUNKING"], "extensions", "unknown extension")
    extensions = json.get("extensions", [])
    check_description(json, "template")
    definitions = json.get("parameterDefinitions", [])
    if "parameterDefinitions" in json:
        check_list(definitions, "parameterDefinitions", 1, 50)
    known, defaults = {}, {}  # known: name -> true where it is for scripts only
    for i, definition in enumerate(definitions):
        check_parameter(definition, f"parameterDefinitions[{i}]")
        name = definition["name"]
        need(f"Param.{name}" not in known, name, "is defined twice")
        known[f"Param.{name}"] = definition["type"] == "PATH"
        known[f"RawParam.{name}"] = False
        if "default" in definition:
            defaults[f"Param.{name}"] = defaults[f"RawParam.{name}"] = definition["default"]
    check_format(json["name"], "name", {name for name in known if not known[name]})
    names = references(json["name"], "name")
    if all(name in defaults for name in names):
        check_text(resolve(json["name"], defaults), "name", 1, 128)
    check_list(json["steps"], "steps")
    for i, step in enumerate(json["steps"]):
        check_step(step, f"steps[{i}]", known, defaults, extensions)
    step_names = [step["name"] for step in json["steps"]]
    need(len(set(step_names)) == len(step_names), "steps", "name a step twice")
    check_dependencies(json["steps"])
