# SPDX-License-Identifier: MIT
# A hand of 24 joints and a wrist: one Spatial for each, by its OpenXR name, in this node's own frame. Godot's axes are those of
# wholehand (right-handed, +y up, meters), so that a pose is taken as it is. Balls and cylinders stand for skin: put your own meshes
# below the nodes instead.
extends Spatial

const PREFIX = "XR_HAND_JOINT_"
const THUMB = ["METACARPAL", "PROXIMAL", "DISTAL", "TIP"]
const FINGER = ["METACARPAL", "PROXIMAL", "INTERMEDIATE", "DISTAL", "TIP"]
const RADIUS = 0.008  # m: of what is drawn; the stream does not say how thick a finger is

var names = []  # of the 24 joints, in the order of the stream's contacts
var _bones = {}  # mesh by the name of the joint where it begins
var _ends = {}  # name of the joint where it ends


func _ready() -> void:
	_add_joint(PREFIX + "WRIST_EXT")
	for finger in ["THUMB", "INDEX", "MIDDLE", "RING", "LITTLE"]:
		var before = ""
		for joint in THUMB if finger == "THUMB" else FINGER:
			var name_of_joint = "%s%s_%s_EXT" % [PREFIX, finger, joint]
			_add_joint(name_of_joint)
			names.append(name_of_joint)
			if before != "":
				_add_bone(before, name_of_joint)
			before = name_of_joint


# A name comes from the network: as a path it could lead to any node of the scene.
func has_joint(joint: String) -> bool:
	return joint == PREFIX + "WRIST_EXT" or joint in names


# A pose as OpenXR has it: -z runs along the bone to the next joint, +y points out of the back of the hand.
func set_joint(joint: String, place: Vector3, turn: Quat) -> void:
	get_node(joint).transform = Transform(Basis(turn.normalized()), place)


# To be called when all joints are set: a bone is as long as its ends are apart.
func stretch_bones() -> void:
	for joint in _bones:
		var length = get_node(joint).translation.distance_to(get_node(_ends[joint]).translation)
		_bones[joint].translation = Vector3(0, 0, -0.5 * length)
		_bones[joint].scale = Vector3(1, max(length, 1e-6), 1)


func _add_joint(joint: String) -> void:
	var node = Spatial.new()
	node.name = joint
	add_child(node)
	var ball = SphereMesh.new()
	ball.radius = RADIUS
	ball.height = 2 * RADIUS
	_add_mesh(node, ball)


func _add_bone(from: String, to: String) -> void:
	var cylinder = CylinderMesh.new()
	cylinder.top_radius = 0.7 * RADIUS
	cylinder.bottom_radius = 0.7 * RADIUS
	cylinder.height = 1
	var mesh = _add_mesh(get_node(from), cylinder)
	mesh.rotation = Vector3(PI / 2, 0, 0)  # its axis is y
	_bones[from] = mesh
	_ends[from] = to


func _add_mesh(parent: Node, shape: Mesh) -> MeshInstance:
	var mesh = MeshInstance.new()
	mesh.mesh = shape
	parent.add_child(mesh)
	return mesh
