// Forces and torques on floating bodies, from C#: copy this file into your project. It calls libbuoyancy-c, whose
// header buoyancy/buoyancy.h has the details: units, ranges, errors, complexity.
//
// SI units. Right-handed axes, up is +z unless you say otherwise. Quaternions are (w, x, y, z). Times are in
// microseconds. Arrays of n poses have 3 n, or 4 n, numbers; they are pinned for the call and never copied.
//
// In Unity: put libbuoyancy-c.so.1 into Assets/Plugins as libbuoyancy-c.so. Unity's axes are left-handed with y up;
// UnityCoordinates converts positions, rotations, velocities, forces, torques and meshes.
//
// Errors of the library are a BuoyancyException with its text. Objects may be used by any number of threads at once.
// Needs C# 7 and no unsafe code.
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Buoyancy
{
    /// <summary>An error of the library: Message says what was wrong, what was expected and what to do.</summary>
    public sealed class BuoyancyException : Exception
    {
        /// <summary>A constant BUOYANCY_ERROR_... of the header.</summary>
        public int Code { get; private set; }

        /// <summary>"MESH" for BUOYANCY_ERROR_MESH, and so on.</summary>
        public string Name { get; private set; }

        internal BuoyancyException(int code, string name, string message) : base(message)
        {
            Code = code;
            Name = name;
        }
    }

    /// <summary>How a mesh is evaluated. Hierarchical is the one to use; the others are published baselines.</summary>
    public enum BuoyancyMethod { Hierarchical = 0, Fast = 1, Improved = 2, Exact = 3, FastSurface = 4, ExactSurface = 5 }

    /// <summary>Why a pose has no result. Such a pose has zeros.</summary>
    public enum PoseStatus
    {
        Ok = 0, NonFinitePose = 2, BadQuaternion = 3, NonFiniteTwist = 4, OpenEdgeWet = 6, OutOfRange = 7, NoSea = 8,
        BadCondition = 9,
        NotCertified = 10
    }

    /// <summary>What Library says about itself.</summary>
    public static class BuoyancyLibrary
    {
        /// <summary>The version of the library that runs, such as "1.0.0".</summary>
        public static string Version { get { return Native.Text(Native.buoyancy_version()); } }
    }

    /// <summary>How a mesh is read. The defaults suit a closed mesh in metres.</summary>
    public sealed class MeshOptions
    {
        /// <summary>Factor of the coordinates, above 0.</summary>
        public double Scale = 1.0;

        /// <summary>Accept an open mesh, and evaluate it where its whole boundary is dry.</summary>
        public bool AcceptDryBoundary = false;
    }

    /// <summary>The water of a query, at rest unless it has a sea.</summary>
    public sealed class Water
    {
        /// <summary>[m]: the surface is where up . x = Level.</summary>
        public double Level = 0.0;

        /// <summary>[kg/m^3], 0 or more.</summary>
        public double Density = 1025.0;

        /// <summary>[m/s^2], 0 or more.</summary>
        public double Gravity = 9.80665;

        /// <summary>A direction of any length above 0.</summary>
        public double[] Up = { 0.0, 0.0, 1.0 };

        /// <summary>Waves, or null. A sea has a level and so on of its own: leave the members above as they are.</summary>
        public BuoyancySea Sea = null;
    }

    /// <summary>n poses, in arrays that stay yours.</summary>
    public sealed class Poses
    {
        /// <summary>[m], world, of the mesh's origin; 3 n.</summary>
        public double[] Positions;

        /// <summary>w, x, y, z; 4 n.</summary>
        public double[] Quaternions;

        /// <summary>[m/s], world, of the mesh's origin; 3 n, or null: at rest. For drag and added mass.</summary>
        public double[] LinearVelocities;

        /// <summary>[rad/s], world; 3 n, or null: at rest. For drag and added mass.</summary>
        public double[] AngularVelocities;

        /// <summary>[us]; n, or 1 for all poses, or null: 0. For waves.</summary>
        public long[] Utimes;

        /// <summary>n poses at the origin, not turned, at rest.</summary>
        public Poses(int count)
        {
            Positions = new double[3 * count];
            Quaternions = new double[4 * count];
            for (int i = 0; i < count; ++i) Quaternions[4 * i] = 1.0;
        }

        /// <summary>n.</summary>
        public int Count { get { return Positions.Length / 3; } }
    }

    /// <summary>The results for n poses. Use one object again and again; set to null what you do not want.</summary>
    public sealed class Wrenches
    {
        /// <summary>Values of PoseStatus; n.</summary>
        public int[] Statuses;

        /// <summary>[N], world; 3 n.</summary>
        public double[] Forces;

        /// <summary>[N m], world, about the mesh's origin, or the reference point of a scene's body; 3 n.</summary>
        public double[] Torques;

        /// <summary>[m^3], under water; n.</summary>
        public double[] Volumes;

        /// <summary>[m], the world's axes, from the position; 3 n.</summary>
        public double[] CentersOfBuoyancy;

        /// <summary>[N], of the norm of the error; n.</summary>
        public double[] ForceErrorBounds;

        /// <summary>[N m], of the norm of the error; n.</summary>
        public double[] TorqueErrorBounds;

        /// <summary>Arrays for n poses.</summary>
        public Wrenches(int count)
        {
            Statuses = new int[count];
            Forces = new double[3 * count];
            Torques = new double[3 * count];
            Volumes = new double[count];
            CentersOfBuoyancy = new double[3 * count];
            ForceErrorBounds = new double[count];
            TorqueErrorBounds = new double[count];
        }
    }

    /// <summary>A mesh that is validated and prepared for queries.</summary>
    public sealed class BuoyancyMesh : IDisposable
    {
        private readonly MeshHandle handle;
        private readonly Native.MeshInfo info;

        /// <summary>Reads a file: OBJ, STL, PLY, OFF, DAE, glTF, GLB, FBX, 3DS, WAMIT .gdf or Nemoh .dat.</summary>
        public BuoyancyMesh(string path, MeshOptions options = null)
        {
            Native.MeshOptions given = Native.Options(options);
            Native.Check(Native.buoyancy_mesh_load(Native.Utf8(path), ref given, out handle));
            info = Info();
        }

        /// <summary>Copies a mesh from arrays.</summary>
        /// <param name="vertices">[m]; 3 per vertex.</param>
        /// <param name="faces">3 vertex numbers per triangle, from 0, counter-clockwise seen from outside.</param>
        /// <param name="options">null for the defaults.</param>
        public BuoyancyMesh(double[] vertices, int[] faces, MeshOptions options = null)
        {
            if (vertices == null || faces == null) throw new ArgumentNullException(vertices == null ? "vertices" : "faces");
            if (vertices.Length % 3 != 0 || faces.Length % 3 != 0)
                throw new ArgumentException("expected three coordinates per vertex and three vertices per face");
            Native.MeshOptions given = Native.Options(options);
            Native.Check(Native.buoyancy_mesh_create(vertices, vertices.Length / 3, faces, faces.Length / 3, ref given,
                                                     out handle));
            info = Info();
        }

        /// <summary>Number of triangles that are used.</summary>
        public long Triangles { get { return info.triangles; } }

        /// <summary>[m^3].</summary>
        public double Volume { get { return info.volume; } }

        /// <summary>[m], of the volume.</summary>
        public double[] Centroid { get { return new[] { info.centroidX, info.centroidY, info.centroidZ }; } }

        /// <summary>Every edge has two faces.</summary>
        public bool IsClosed { get { return info.closed != 0; } }

        /// <summary>The mesh was inside out, and has been turned.</summary>
        public bool WasFlipped { get { return info.flipped != 0; } }

        /// <summary>Evaluates the mesh at all poses.</summary>
        /// <param name="poses">n poses.</param>
        /// <param name="wrenches">Arrays for at least n poses, which are set.</param>
        /// <param name="water">null for the defaults.</param>
        /// <param name="method">Hierarchical, unless you compare methods.</param>
        /// <param name="tolerance">0 to 1, of the weight of the whole displacement; 0 is exact.</param>
        /// <param name="threads">1: this thread, 0: all of the machine.</param>
        public void Query(Poses poses, Wrenches wrenches, Water water = null,
                          BuoyancyMethod method = BuoyancyMethod.Hierarchical, double tolerance = 0.0, int threads = 1)
        {
            BuoyancySea sea = water == null ? null : water.Sea;
            bool seaIsHeld = false;
            Pins pins = Pins.Begin();
            try
            {
                Native.Poses at = Native.Pin(pins, poses);
                Native.Wrenches to = Native.Pin(pins, wrenches, poses.Count);
                Native.Water within = Native.Convert(water ?? Native.DefaultWater);
                if (sea != null)
                {
                    sea.Handle.DangerousAddRef(ref seaIsHeld);
                    within.sea = sea.Handle.DangerousGetHandle();
                }
                Native.Check(Native.buoyancy_mesh_query(handle, ref within, (int)method, tolerance, ref at, ref to, threads));
            }
            finally
            {
                if (seaIsHeld) sea.Handle.DangerousRelease();
                pins.Dispose();
            }
        }

        /// <summary>Frees the mesh. No call may be using it.</summary>
        public void Dispose() { handle.Dispose(); }

        private Native.MeshInfo Info()
        {
            Native.MeshInfo found = new Native.MeshInfo { size = Native.SizeOf(typeof(Native.MeshInfo)) };
            Native.Check(Native.buoyancy_mesh_get_info(handle, ref found));
            return found;
        }
    }

    /// <summary>A surface with waves.</summary>
    public sealed class BuoyancySea : IDisposable
    {
        internal readonly SeaHandle Handle;

        /// <summary>Parses the sections [world] and [water] of a scene file.</summary>
        /// <param name="toml">The text.</param>
        /// <param name="directory">Where files that it names are looked up; null: the current directory.</param>
        public BuoyancySea(string toml, string directory = null)
        {
            Native.Check(Native.buoyancy_sea_from_toml(Native.Utf8(toml), Native.Utf8(directory), out Handle));
        }

        internal BuoyancySea(SeaHandle handle) { Handle = handle; }

        /// <summary>Sets elevations[i] to the height of the surface over the level [m] at x1[i], x2[i].</summary>
        /// <param name="x1">[m], along the first horizontal axis: the world's x if up is z.</param>
        /// <param name="x2">[m], along the second: the world's y if up is z.</param>
        /// <param name="utime">[us].</param>
        /// <param name="elevations">As long as x1 and x2.</param>
        /// <param name="threads">1: this thread, 0: all of the machine.</param>
        public void Elevations(double[] x1, double[] x2, long utime, double[] elevations, int threads = 1)
        {
            if (x1 == null || x2 == null || elevations == null || x2.Length != x1.Length || elevations.Length != x1.Length)
                throw new ArgumentException("expected x1, x2 and elevations of one length");
            Native.Check(Native.buoyancy_sea_elevations(Handle, x1.Length, x1, x2, new[] { utime }, 1, elevations, threads));
        }

        /// <summary>Frees the sea. No call may be using it.</summary>
        public void Dispose() { Handle.Dispose(); }
    }

    /// <summary>The water, the waves and the bodies of a scene file.</summary>
    public sealed class BuoyancyScene : IDisposable
    {
        private readonly SceneHandle handle;

        /// <summary>Reads a scene file.</summary>
        public BuoyancyScene(string path) { Native.Check(Native.buoyancy_scene_load(Native.Utf8(path), out handle)); }

        private BuoyancyScene(SceneHandle parsed) { handle = parsed; }

        /// <summary>Parses the text of a scene file.</summary>
        /// <param name="toml">The text.</param>
        /// <param name="directory">Where files that it names are looked up; null: the current directory.</param>
        public static BuoyancyScene FromToml(string toml, string directory = null)
        {
            SceneHandle parsed;
            Native.Check(Native.buoyancy_scene_from_toml(Native.Utf8(toml), Native.Utf8(directory), out parsed));
            return new BuoyancyScene(parsed);
        }

        /// <summary>The ids of the bodies, in the order of the file.</summary>
        public int[] BodyIds()
        {
            long count;
            Native.Check(Native.buoyancy_scene_body_count(handle, out count));
            int[] ids = new int[count];
            for (int i = 0; i < ids.Length; ++i)
            {
                Native.BodyInfo body = new Native.BodyInfo { size = Native.SizeOf(typeof(Native.BodyInfo)) };
                Native.Check(Native.buoyancy_scene_get_body(handle, i, ref body));
                ids[i] = body.id;
            }
            return ids;
        }

        /// <summary>The scene's sea, for instance to draw it; dispose of it too.</summary>
        public BuoyancySea Sea()
        {
            SeaHandle sea;
            Native.Check(Native.buoyancy_scene_sea(handle, out sea));
            return new BuoyancySea(sea);
        }

        /// <summary>Evaluates a body at all poses in the scene's water, with its drag and added mass.</summary>
        /// <param name="bodyId">As in the scene file.</param>
        /// <param name="poses">n poses, with velocities for a body with drag or added mass.</param>
        /// <param name="wrenches">Arrays for at least n poses, which are set.</param>
        /// <param name="threads">1: this thread, 0: all of the machine.</param>
        public void Query(int bodyId, Poses poses, Wrenches wrenches, int threads = 1)
        {
            Pins pins = Pins.Begin();
            try
            {
                Native.Poses at = Native.Pin(pins, poses);
                Native.Wrenches to = Native.Pin(pins, wrenches, poses.Count);
                Native.Check(Native.buoyancy_scene_query(handle, bodyId, ref at, ref to, IntPtr.Zero, threads));
            }
            finally
            {
                pins.Dispose();
            }
        }

        /// <summary>Frees the scene. No call may be using it.</summary>
        public void Dispose() { handle.Dispose(); }
    }

    /// <summary>
    /// Unity's axes are x right, y up, z forward, left-handed; here they are x, z forward as y, and y up as z,
    /// right-handed. Vectors swap y and z. Axial vectors (angular velocities, torques), which change their sign in a
    /// mirror, also do that; quaternions do it to their vector part. Triangles run the other way around. All
    /// conversions are their own inverses.
    /// </summary>
    public static class UnityCoordinates
    {
        /// <summary>Sets vector i of an array to Unity's position, velocity or force (x, y, z).</summary>
        public static void SetVector(double[] array, int i, double x, double y, double z)
        {
            array[3 * i] = x;
            array[3 * i + 1] = z;
            array[3 * i + 2] = y;
        }

        /// <summary>Sets vector i of an array to Unity's angular velocity or torque (x, y, z).</summary>
        public static void SetAxialVector(double[] array, int i, double x, double y, double z)
        {
            SetVector(array, i, -x, -y, -z);
        }

        /// <summary>Sets quaternion i of an array to Unity's rotation (x, y, z, w).</summary>
        public static void SetQuaternion(double[] array, int i, double x, double y, double z, double w)
        {
            array[4 * i] = w;
            array[4 * i + 1] = -x;
            array[4 * i + 2] = -z;
            array[4 * i + 3] = -y;
        }

        /// <summary>Vector i of an array, such as a force, in Unity's axes.</summary>
        public static void GetVector(double[] array, int i, out double x, out double y, out double z)
        {
            x = array[3 * i];
            y = array[3 * i + 2];
            z = array[3 * i + 1];
        }

        /// <summary>Vector i of an array of torques or angular velocities in Unity's axes.</summary>
        public static void GetAxialVector(double[] array, int i, out double x, out double y, out double z)
        {
            GetVector(array, i, out x, out y, out z);
            x = -x;
            y = -y;
            z = -z;
        }

        /// <summary>The triangles of Unity's mesh, with the winding of the converted vertices.</summary>
        public static int[] Faces(int[] triangles)
        {
            int[] faces = (int[])triangles.Clone();
            for (int i = 0; i + 2 < faces.Length; i += 3)
            {
                faces[i + 1] = triangles[i + 2];
                faces[i + 2] = triangles[i + 1];
            }
            return faces;
        }

#if UNITY_5_3_OR_NEWER
        /// <summary>The vertices of Unity's mesh: new BuoyancyMesh(Vertices(mesh.vertices), Faces(mesh.triangles)).</summary>
        public static double[] Vertices(UnityEngine.Vector3[] vertices)
        {
            double[] converted = new double[3 * vertices.Length];
            for (int i = 0; i < vertices.Length; ++i) SetVector(converted, i, vertices[i]);
            return converted;
        }

        /// <summary>Sets vector i of an array to a position, velocity or force.</summary>
        public static void SetVector(double[] array, int i, UnityEngine.Vector3 vector)
        {
            SetVector(array, i, vector.x, vector.y, vector.z);
        }

        /// <summary>Sets vector i of an array to an angular velocity or torque.</summary>
        public static void SetAxialVector(double[] array, int i, UnityEngine.Vector3 vector)
        {
            SetAxialVector(array, i, vector.x, vector.y, vector.z);
        }

        /// <summary>Sets quaternion i of an array to a rotation.</summary>
        public static void SetQuaternion(double[] array, int i, UnityEngine.Quaternion rotation)
        {
            // Unity's floats are unit to 1e-7 only, which the library accepts.
            SetQuaternion(array, i, rotation.x, rotation.y, rotation.z, rotation.w);
        }

        /// <summary>Vector i of an array, such as a force: rigidbody.AddForce(Vector(wrenches.Forces, 0)).</summary>
        public static UnityEngine.Vector3 Vector(double[] array, int i)
        {
            double x, y, z;
            GetVector(array, i, out x, out y, out z);
            return new UnityEngine.Vector3((float)x, (float)y, (float)z);
        }

        /// <summary>Vector i of an array of torques: rigidbody.AddTorque(AxialVector(wrenches.Torques, 0)).</summary>
        public static UnityEngine.Vector3 AxialVector(double[] array, int i)
        {
            double x, y, z;
            GetAxialVector(array, i, out x, out y, out z);
            return new UnityEngine.Vector3((float)x, (float)y, (float)z);
        }
#endif
    }

    // The arrays of one call, pinned until it returns. Each thread uses one object again, so that a call makes no garbage.
    internal sealed class Pins
    {
        [ThreadStatic] private static Pins ofThread;
        private readonly GCHandle[] handles = new GCHandle[16];
        private int count;

        public static Pins Begin()
        {
            if (ofThread == null) ofThread = new Pins();
            return ofThread;
        }

        // The address of an array that has at least `length` elements; null gives a null pointer.
        public IntPtr Add(Array array, long length, string name)
        {
            if (array == null) return IntPtr.Zero;
            if (array.Length < length)
                throw new ArgumentException(name + " has " + array.Length + " elements; expected " + length);
            handles[count] = GCHandle.Alloc(array, GCHandleType.Pinned);
            return handles[count++].AddrOfPinnedObject();
        }

        public void Dispose()
        {
            while (count > 0) handles[--count].Free();
        }
    }

    internal abstract class NativeHandle : SafeHandle
    {
        protected NativeHandle() : base(IntPtr.Zero, true) { }
        public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
    }

    internal sealed class MeshHandle : NativeHandle
    {
        protected override bool ReleaseHandle() { return Native.buoyancy_mesh_free(handle) == 0; }
    }

    internal sealed class SeaHandle : NativeHandle
    {
        protected override bool ReleaseHandle() { return Native.buoyancy_sea_free(handle) == 0; }
    }

    internal sealed class SceneHandle : NativeHandle
    {
        protected override bool ReleaseHandle() { return Native.buoyancy_scene_free(handle) == 0; }
    }

    // The functions and structs of buoyancy/buoyancy.h.
    internal static class Native
    {
#if UNITY_5_3_OR_NEWER
        private const string Library = "buoyancy-c";
#else
        private const string Library = "libbuoyancy-c.so.1";
#endif
        internal static readonly Buoyancy.Water DefaultWater = new Buoyancy.Water();

        [StructLayout(LayoutKind.Sequential)]
        internal struct MeshOptions
        {
            public UIntPtr size;
            public double scale;
            public int open, countIntersectingPairs;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct MeshInfo
        {
            public UIntPtr size;
            public long triangles, verticesStored, verticesWelded;
            public double minX, minY, minZ, maxX, maxY, maxZ, diagonal, area, volume, centroidX, centroidY, centroidZ;
            public double inertiaXX, inertiaXY, inertiaXZ, inertiaYX, inertiaYY, inertiaYZ, inertiaZX, inertiaZY, inertiaZZ;
            public long boundaryEdges, nonManifoldEdges, misorientedEdges, degenerateFaces, droppedFaces, duplicateFaces;
            public long intersectingPairs, components, holes;
            public int closed, flipped;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Water
        {
            public UIntPtr size;
            public double level, density, gravity, upX, upY, upZ;
            public IntPtr sea;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Poses
        {
            public UIntPtr size;
            public long count;
            public IntPtr positions, quaternions, linearVelocities, angularVelocities, utimes;
            public long utimeCount;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Wrenches
        {
            public UIntPtr size;
            public IntPtr statuses, forces, torques, volumes, centersOfBuoyancy, forceErrorBounds, torqueErrorBounds;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct BodyInfo
        {
            public UIntPtr size;
            public IntPtr name;
            public int id, method;
            public double tolerance, referenceX, referenceY, referenceZ, centerX, centerY, centerZ, volume;
            public long triangles;
            public int hasLoads, hasHydrostatics;
        }

        internal static UIntPtr SizeOf(Type type) { return (UIntPtr)(uint)Marshal.SizeOf(type); }

        internal static MeshOptions Options(Buoyancy.MeshOptions options)
        {
            return new MeshOptions
            {
                size = SizeOf(typeof(MeshOptions)),
                scale = options == null ? 1.0 : options.Scale,
                open = options != null && options.AcceptDryBoundary ? 1 : 0
            };
        }

        internal static Water Convert(Buoyancy.Water water)
        {
            if (water.Up == null || water.Up.Length != 3) throw new ArgumentException("Water.Up: expected three numbers");
            return new Water
            {
                size = SizeOf(typeof(Water)),
                level = water.Level,
                density = water.Density,
                gravity = water.Gravity,
                upX = water.Up[0],
                upY = water.Up[1],
                upZ = water.Up[2]
            };
        }

        internal static Poses Pin(Pins pins, Buoyancy.Poses poses)
        {
            if (poses == null) throw new ArgumentNullException("poses");
            if (poses.Positions == null || poses.Positions.Length % 3 != 0 || poses.Quaternions == null)
                throw new ArgumentException("poses: expected 3 n numbers as Positions and 4 n as Quaternions");
            long n = poses.Count;
            long times = poses.Utimes == null ? 0 : poses.Utimes.Length;
            return new Poses
            {
                size = SizeOf(typeof(Poses)),
                count = n,
                positions = pins.Add(poses.Positions, 3 * n, "Positions"),
                quaternions = pins.Add(poses.Quaternions, 4 * n, "Quaternions"),
                linearVelocities = pins.Add(poses.LinearVelocities, 3 * n, "LinearVelocities"),
                angularVelocities = pins.Add(poses.AngularVelocities, 3 * n, "AngularVelocities"),
                utimes = pins.Add(poses.Utimes, times, "Utimes"),
                utimeCount = times
            };
        }

        internal static Wrenches Pin(Pins pins, Buoyancy.Wrenches wrenches, long n)
        {
            if (wrenches == null) throw new ArgumentNullException("wrenches");
            return new Wrenches
            {
                size = SizeOf(typeof(Wrenches)),
                statuses = pins.Add(wrenches.Statuses, n, "Statuses"),
                forces = pins.Add(wrenches.Forces, 3 * n, "Forces"),
                torques = pins.Add(wrenches.Torques, 3 * n, "Torques"),
                volumes = pins.Add(wrenches.Volumes, n, "Volumes"),
                centersOfBuoyancy = pins.Add(wrenches.CentersOfBuoyancy, 3 * n, "CentersOfBuoyancy"),
                forceErrorBounds = pins.Add(wrenches.ForceErrorBounds, n, "ForceErrorBounds"),
                torqueErrorBounds = pins.Add(wrenches.TorqueErrorBounds, n, "TorqueErrorBounds")
            };
        }

        internal static void Check(int error)
        {
            if (error != 0) throw new BuoyancyException(error, Text(buoyancy_error_name(error)), Text(buoyancy_last_error()));
        }

        // UTF-8 with a final zero byte; null stays null.
        internal static byte[] Utf8(string text)
        {
            if (text == null) return null;
            if (text.IndexOf('\0') >= 0) throw new ArgumentException("expected a text without zero characters");
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        internal static string Text(IntPtr utf8)
        {
            int length = 0;
            while (Marshal.ReadByte(utf8, length) != 0) ++length;
            byte[] bytes = new byte[length];
            Marshal.Copy(utf8, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr buoyancy_version();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr buoyancy_last_error();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr buoyancy_error_name(int error);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_mesh_load(byte[] path, ref MeshOptions options, out MeshHandle mesh);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_mesh_create(double[] vertices, long vertexCount, int[] faces, long faceCount,
                                                        ref MeshOptions options, out MeshHandle mesh);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_mesh_free(IntPtr mesh);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_mesh_get_info(MeshHandle mesh, ref MeshInfo info);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_mesh_query(MeshHandle mesh, ref Water water, int method, double tolerance,
                                                       ref Poses poses, ref Wrenches wrenches, int threads);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_sea_from_toml(byte[] toml, byte[] directory, out SeaHandle sea);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_sea_free(IntPtr sea);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_sea_elevations(SeaHandle sea, long count, double[] x1, double[] x2, long[] utimes,
                                                           long utimeCount, [In, Out] double[] elevations, int threads);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_load(byte[] path, out SceneHandle scene);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_from_toml(byte[] toml, byte[] directory, out SceneHandle scene);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_free(IntPtr scene);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_body_count(SceneHandle scene, out long count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_get_body(SceneHandle scene, long index, ref BodyInfo info);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_sea(SceneHandle scene, out SeaHandle sea);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int buoyancy_scene_query(SceneHandle scene, int bodyId, ref Poses poses, ref Wrenches wrenches,
                                                        IntPtr loads, int threads);
    }
}
