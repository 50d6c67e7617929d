# SPDX-License-Identifier: MIT
# Uses the class Wholehand of examples/godot-library and writes what it sees as JSON, which godot_library_test.py judges.
#   godot3-server --path PROJECT -s library_check.gd --scene=FILE --bad=FILE --write=FILE
extends SceneTree

const GAP = [0.0, 0.12]
const SOME = {"height": 0.06, "azimuth": 0.5, "obliquity": 0.1, "roll": -0.4, "offset": 0.002, "hand_scale": 1.02}

var _wholehand = load("res://wholehand.gdns").new()
var _hand = load("res://hand.gd").new()


func _initialize() -> void:
	root.add_child(_hand)
	_wholehand.open(_option("scene"))
	var seen = {}
	seen["names"] = _wholehand.joint_names()
	seen["version"] = _wholehand.version()
	var vessel = _wholehand.vessels()[0]
	seen["vessel"] = [vessel.name, _real(vessel.highest), _real(vessel.mass), _vector(vessel.place)]
	seen["grip"] = _grip()
	seen["grip_json"] = _wholehand.grip_json("beaker", SOME)
	seen["session"] = _session()
	seen["refusals"] = _refusals()
	seen["thread"] = _thread()
	var file = File.new()
	file.open(_option("write"), File.WRITE)
	file.store_string(to_json(seen))
	file.close()
	quit()


func _option(name: String) -> String:
	for argument in OS.get_cmdline_args():
		if argument.begins_with("--%s=" % name):
			return argument.trim_prefix("--%s=" % name)
	return ""


# With more digits than to_json() writes.
func _real(number: float) -> String:
	return "%.15f" % number


func _vector(place: Vector3) -> Array:
	return [_real(place.x), _real(place.y), _real(place.z)]


func _quat(turn: Quat) -> Array:
	return [_real(turn.x), _real(turn.y), _real(turn.z), _real(turn.w)]


# What the nodes of the hand say.
func _nodes() -> Array:
	var places = []
	for joint in _hand.names:
		places.append(_vector(_hand.get_node(joint).global_transform.origin))
	return places


func _grip() -> Dictionary:
	var grip = _wholehand.grip("beaker", SOME)
	for j in range(24):
		_hand.set_joint(_hand.names[j], grip.joints[j], Quat())
	return {"feasible": grip.feasible, "reason": grip.reason, "closure": _real(grip.closure), "score": _real(grip.score),
		"touch_mask": grip.touch_mask, "nodes": _nodes()}


# As in unity_check.cs: it leans by 0.3 rad, comes open, closes in 0.2 s, and lifts and tilts from 0.3 s to 0.6 s.
func _gripper(tick: int) -> Array:
	var closed = min(1.0, tick / 200.0)
	var lifted = clamp((tick - 300) / 300.0, 0.0, 1.0)
	var turn = Quat(sin(0.15 + 0.2 * lifted), 0, 0, cos(0.15 + 0.2 * lifted))
	return [Vector3(0.06, 0.055 + 0.05 * lifted, 0.03 * lifted), turn, GAP[1] - 0.06 * closed]


func _session() -> Dictionary:
	_wholehand.session_open(GAP[0], GAP[1])
	var seen = {"period": _wholehand.session_period(), "states": [], "gripper": _quat(_gripper(0)[1])}
	var out = {}
	for tick in range(700):
		var at = _gripper(tick)
		out = _wholehand.session_step(tick, at[0], at[1], at[2])
		if seen.states.empty() or seen.states[-1] != out.state:
			seen.states.append(out.state)
			if out.state == "lift":
				seen["tips"] = [_vector(out.thumb), _vector(out.index)]
				seen["stood"] = [_vector(out.vessel_place), _quat(out.vessel_turn)]
	var hand = _wholehand.session_hand()
	for j in range(24):
		_hand.set_joint(_hand.names[j], hand.joints[j], hand.turns[j])
	_hand.set_joint("XR_HAND_JOINT_WRIST_EXT", hand.wrist, hand.wrist_turn)
	_hand.stretch_bones()
	seen["nodes"] = _nodes()
	seen["turns"] = []
	for joint in _hand.names:
		seen.turns.append(_quat(_hand.get_node(joint).global_transform.basis.get_rotation_quat()))
	seen["vessel"] = [_vector(out.vessel_place), _quat(out.vessel_turn)]
	seen["grasps"] = out.grasps
	seen["weight"] = out.weight
	seen["tilt"] = out.tilt
	return seen


# The line of each; "" where it was accepted.
func _refusals() -> Dictionary:
	var other = load("res://wholehand.gdns").new()
	var at = _gripper(0)
	var seen = {}
	seen["no scene"] = _line(other, other.vessels())
	seen["bad scene"] = _line(other, other.open(_option("bad")))
	seen["type"] = _line(other, other.open(7))
	seen["count"] = _line(other, other.open())
	seen["no session"] = _line(other, other.session_start(at[0], at[1], at[2]))
	seen["no thread"] = _line(other, other.session_newest())
	seen["vessel"] = _line(_wholehand, _wholehand.grip("bucket", {}))
	seen["key"] = _line(_wholehand, _wholehand.grip("beaker", {"heigth": 0.06}))
	seen["number"] = _line(_wholehand, _wholehand.grip("beaker", {"height": "high"}))
	seen["same tick"] = _line(_wholehand, _wholehand.session_step(699, at[0], at[1], at[2]))
	seen["not finite"] = _line(_wholehand, _wholehand.session_step(700, at[0], at[1], NAN))
	seen["place"] = _line(_wholehand, _wholehand.session_step(701, 1.0, at[1], at[2]))
	return seen


func _line(who, answer) -> String:
	return who.message() if answer == null else ""


# At the places of _gripper, as far as this thread's own clock says.
func _thread() -> Dictionary:
	_wholehand.session_open(GAP[0], GAP[1])
	var at = _gripper(0)
	_wholehand.session_start(at[0], at[1], at[2])
	var refused = _line(_wholehand, _wholehand.session_step(1, at[0], at[1], at[2]))
	var seen = null
	var ticks = 0
	for k in range(6000):
		OS.delay_msec(10)
		at = _gripper(10 * k)
		_wholehand.session_move(at[0], at[1], at[2])
		seen = _wholehand.session_newest()
		if seen != null and seen.grasps > 0:
			ticks = seen.tick
			break
	var hand = _wholehand.session_hand()
	# what is no number ends the session, and the next call says so
	_wholehand.session_move(at[0], at[1], NAN)
	var failed = ""
	for k in range(6000):
		OS.delay_msec(10)
		if _wholehand.session_newest() == null:
			failed = _wholehand.message()
			break
	_wholehand.session_stop()
	return {"refused": refused, "ticks": ticks, "grasps": seen.grasps, "wrist": _vector(hand.wrist), "failed": failed}
