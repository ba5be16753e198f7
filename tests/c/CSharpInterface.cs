// Compares what Buoyancy.cs computes with the table of write_comparison_table byte for byte, and tests its errors, its
// handles and its conversion of Unity's coordinates.
//
//     CSharpInterface.exe TABLE
using System;
using System.IO;
using System.Text;
using System.Threading;
using Buoyancy;

#if UNITY_5_3_OR_NEWER
// What the conversions use of Unity.
namespace UnityEngine
{
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }

    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }
}
#endif

internal static class CSharpInterface
{
    private static void Expect(bool condition, string what)
    {
        if (condition) return;
        Console.WriteLine("failed: " + what);
        Environment.Exit(1);
    }

    // The exception that an action throws.
    private static T Thrown<T>(Action action) where T : Exception
    {
        try
        {
            action();
        }
        catch (T exception)
        {
            return exception;
        }
        Expect(false, "an expected " + typeof(T));
        return null;
    }

    private sealed class Table
    {
        private readonly byte[] bytes;
        private int offset;

        public Table(string path) { bytes = File.ReadAllBytes(path); }

        public bool IsComplete { get { return offset == bytes.Length; } }

        public byte[] Bytes(long count)
        {
            byte[] part = new byte[count];
            Array.Copy(bytes, offset, part, 0, count);
            offset += (int)((count + 7) / 8 * 8);
            return part;
        }

        public double[] Doubles(long count)
        {
            double[] numbers = new double[count];
            Buffer.BlockCopy(Bytes(8 * count), 0, numbers, 0, (int)(8 * count));
            return numbers;
        }

        public long[] Longs(long count)
        {
            long[] numbers = new long[count];
            Buffer.BlockCopy(Bytes(8 * count), 0, numbers, 0, (int)(8 * count));
            return numbers;
        }

        public void Expect(Array computed, int bytesEach, string what)
        {
            byte[] expected = Bytes(bytesEach * computed.Length);
            byte[] found = new byte[expected.Length];
            Buffer.BlockCopy(computed, 0, found, 0, found.Length);
            for (int i = 0; i < found.Length; ++i)
                CSharpInterface.Expect(found[i] == expected[i], "the " + what + " equal those of C++");
        }
    }

    private static void Compare(Table table)
    {
        long[] header = table.Longs(8);
        double[] numbers = table.Doubles(7);
        string text = Encoding.UTF8.GetString(table.Bytes(header[6])), path = Encoding.UTF8.GetString(table.Bytes(header[7]));
        double[] vertices = table.Doubles(3 * header[0]);
        int[] faces = Array.ConvertAll(table.Longs(3 * header[1]), index => (int)index);
        int n = (int)header[2];
        Poses poses = new Poses(n)
        {
            Positions = table.Doubles(3 * n), Quaternions = table.Doubles(4 * n), LinearVelocities = table.Doubles(3 * n),
            AngularVelocities = table.Doubles(3 * n), Utimes = table.Longs(header[3])
        };
        Wrenches wrenches = new Wrenches(n);
        if (header[5] >= 0)
        {
            using (BuoyancyScene scene = BuoyancyScene.FromToml(text)) scene.Query((int)header[5], poses, wrenches, 0);
        }
        else
        {
            Water water = new Water { Level = numbers[1], Density = numbers[2], Gravity = numbers[3],
                                      Up = new[] { numbers[4], numbers[5], numbers[6] } };
            using (BuoyancyMesh mesh = path != "" ? new BuoyancyMesh(path) : new BuoyancyMesh(vertices, faces))
            using (BuoyancySea sea = text == "" ? null : new BuoyancySea(text))
            {
                water.Sea = sea;
                mesh.Query(poses, wrenches, water, (BuoyancyMethod)header[4], numbers[0], 0);
            }
        }
        table.Expect(wrenches.Statuses, 4, "statuses");
        table.Expect(wrenches.Forces, 8, "forces");
        table.Expect(wrenches.Torques, 8, "torques");
        table.Expect(wrenches.Volumes, 8, "volumes");
        table.Expect(wrenches.CentersOfBuoyancy, 8, "centres of buoyancy");
        table.Expect(wrenches.ForceErrorBounds, 8, "bounds of the force");
        table.Expect(wrenches.TorqueErrorBounds, 8, "bounds of the torque");
    }

    private static readonly double[] tetrahedron = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    private static readonly int[] tetrahedronFaces = { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 };

    private static void TestErrors()
    {
        BuoyancyException error = Thrown<BuoyancyException>(() => new BuoyancyMesh("no/such/mésh.obj"));
        Expect(error.Name == "FILE" && error.Message.Contains("no/such/mésh.obj"), "the file is named: " + error.Message);
        error = Thrown<BuoyancyException>(() => new BuoyancyMesh(tetrahedron, new[] { 0, 1, 7 }));
        Expect(error.Name == "MESH" && error.Message.Contains("vertex index 7"), "the index is named: " + error.Message);
        error = Thrown<BuoyancyException>(() => new BuoyancySea("[water]\nlevl = 1"));
        Expect(error.Name == "SCENE" && error.Message.Contains("level"), "the key is named: " + error.Message);
        Thrown<ArgumentException>(() => new BuoyancyMesh(tetrahedron, new[] { 0, 1 }));
        Thrown<ArgumentNullException>(() => new BuoyancyMesh(null, new[] { 0, 1 }));
        Thrown<ArgumentException>(() => new BuoyancySea("[water]\0"));

        BuoyancyMesh mesh = new BuoyancyMesh(tetrahedron, tetrahedronFaces);
        Expect(mesh.Triangles == 4 && mesh.IsClosed && Math.Abs(mesh.Volume - 1.0 / 6.0) < 1e-15, "the report");
        Expect(Math.Abs(mesh.Centroid[2] - 0.25) < 1e-15, "the centroid");
        Poses poses = new Poses(3);
        Thrown<ArgumentException>(() => mesh.Query(poses, new Wrenches(2)));
        // The library trusts the lengths of arrays, so the classes check every one.
        Wrenches[] tooShort = {
            new Wrenches(3) { Statuses = new int[2] }, new Wrenches(3) { Forces = new double[8] },
            new Wrenches(3) { Torques = new double[8] }, new Wrenches(3) { Volumes = new double[2] },
            new Wrenches(3) { CentersOfBuoyancy = new double[8] }, new Wrenches(3) { ForceErrorBounds = new double[2] },
            new Wrenches(3) { TorqueErrorBounds = new double[2] } };
        foreach (Wrenches given in tooShort) Thrown<ArgumentException>(() => mesh.Query(poses, given));
        Thrown<ArgumentException>(() => mesh.Query(new Poses(3) { Quaternions = new double[11] }, new Wrenches(3)));
        Thrown<ArgumentException>(() => mesh.Query(new Poses(3) { LinearVelocities = new double[8] }, new Wrenches(3)));
        Thrown<ArgumentException>(() => mesh.Query(new Poses(3) { AngularVelocities = new double[8] }, new Wrenches(3)));
        Thrown<BuoyancyException>(() => mesh.Query(new Poses(3) { Utimes = new long[2] }, new Wrenches(3)));
        Thrown<ArgumentNullException>(() => mesh.Query(poses, null));
        Thrown<BuoyancyException>(() => mesh.Query(poses, new Wrenches(3), null, (BuoyancyMethod)17));
        Thrown<BuoyancyException>(() => mesh.Query(poses, new Wrenches(3), new Water { Density = double.NaN }));
        poses.Positions[3] = double.NaN;
        Wrenches wrenches = new Wrenches(3) { Torques = null };
        mesh.Query(poses, wrenches);
        Expect(wrenches.Statuses[1] == (int)PoseStatus.NonFinitePose && wrenches.Statuses[2] == 0, "the statuses");
        BuoyancySea sea = new BuoyancySea("");
        sea.Dispose();
        Thrown<ObjectDisposedException>(() => mesh.Query(poses, wrenches, new Water { Sea = sea }));
        mesh.Dispose();
        mesh.Dispose();
        Thrown<ObjectDisposedException>(() => mesh.Query(poses, wrenches));
    }

    private static void TestScene()
    {
        string path = Path.Combine(Path.GetTempPath(), "scène-" + Guid.NewGuid() + ".toml");
        File.WriteAllText(path, "[water]\nwaves = { type = \"regular\", height = 0.4, period = 3 }\n" +
                                "[[body]]\nid = 4\nshape = { type = \"box\" }\n[[body]]\nid = 2\nshape = { type = \"box\" }\n");
        using (BuoyancyScene scene = new BuoyancyScene(path))
        using (BuoyancySea sea = scene.Sea())
        {
            File.Delete(path);
            int[] ids = scene.BodyIds();
            Expect(ids.Length == 2 && ids[0] == 4 && ids[1] == 2, "the ids of the bodies");
            double[] elevations = new double[2];
            sea.Elevations(new[] { 0.0, 5.0 }, new[] { 0.0, 0.0 }, 0, elevations);
            Expect(Math.Abs(elevations[0] - 0.2) < 1e-12 && Math.Abs(elevations[1]) <= 0.2, "the elevations");
            Thrown<ArgumentException>(() => sea.Elevations(new double[2], new double[3], 0, elevations));
        }
    }

    private static void TestThreads()
    {
        using (BuoyancyMesh mesh = new BuoyancyMesh(tetrahedron, tetrahedronFaces))
        {
            double[] forces = new double[4];
            Thread[] threads = new Thread[forces.Length];
            for (int i = 0; i < threads.Length; ++i)
            {
                int own = i;
                threads[i] = new Thread(() =>
                {
                    Poses poses = new Poses(1);
                    Wrenches wrenches = new Wrenches(1);
                    for (int repeat = 0; repeat < 200; ++repeat)
                    {
                        poses.Positions[2] = -0.5;
                        mesh.Query(poses, wrenches);
                        BuoyancyException error = Thrown<BuoyancyException>(() => new BuoyancySea("key" + own + " = 1"));
                        Expect(error.Message.Contains("key" + own), "each thread has its error");
                    }
                    forces[own] = wrenches.Forces[2];
                });
                threads[i].Start();
            }
            foreach (Thread thread in threads) thread.Join();
            foreach (double force in forces) Expect(force > 0.0 && force == forces[0], "threads compute the same");
        }
    }

    // v turned by the unit quaternion (x, y, z, w): v + 2 w (q x v) + 2 q x (q x v), in axes of either hand.
    private static double[] Turned(double[] q, double[] v)
    {
        double[] c = Cross(q, v);
        double[] d = Cross(q, c);
        return new[] { v[0] + 2 * (q[3] * c[0] + d[0]), v[1] + 2 * (q[3] * c[1] + d[1]), v[2] + 2 * (q[3] * c[2] + d[2]) };
    }

    private static double[] Cross(double[] a, double[] b)
    {
        return new[] { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    }

    private static void ExpectEqual(double[] a, double[] b, string what)
    {
        for (int i = 0; i < 3; ++i) Expect(Math.Abs(a[i] - b[i]) < 1e-12, what);
    }

    private static void TestUnityCoordinates()
    {
        double[] q = { 0.1, -0.5, 0.7, Math.Sqrt(1.0 - 0.01 - 0.25 - 0.49) }, v = { 1.5, -2.0, 0.3 }, w = { 0.4, 0.6, -1.1 };
        double[] quaternion = new double[4], a = new double[3], b = new double[3], c = new double[3];
        UnityCoordinates.SetQuaternion(quaternion, 0, q[0], q[1], q[2], q[3]);
        double[] converted = { quaternion[1], quaternion[2], quaternion[3], quaternion[0] };
        double[] turned = Turned(q, v);
        UnityCoordinates.SetVector(a, 0, v[0], v[1], v[2]);
        UnityCoordinates.SetVector(b, 0, turned[0], turned[1], turned[2]);
        ExpectEqual(Turned(converted, a), b, "rotations turn converted vectors alike");
        // The moment of a force about a point is an axial vector.
        double[] moment = Cross(v, w);
        UnityCoordinates.SetVector(b, 0, w[0], w[1], w[2]);
        UnityCoordinates.SetAxialVector(c, 0, moment[0], moment[1], moment[2]);
        ExpectEqual(Cross(a, b), c, "moments of converted forces");
        double x, y, z;
        UnityCoordinates.GetAxialVector(c, 0, out x, out y, out z);
        ExpectEqual(new[] { x, y, z }, moment, "axial vectors come back");
        UnityCoordinates.GetVector(a, 0, out x, out y, out z);
        ExpectEqual(new[] { x, y, z }, v, "vectors come back");

        // In Unity's axes (b - a) x (c - a) points outward too, and up is y.
        int[] faces = UnityCoordinates.Faces(tetrahedronFaces);
        double[] vertices = new double[12];
        for (int i = 0; i < 4; ++i)
            UnityCoordinates.SetVector(vertices, i, tetrahedron[3 * i], tetrahedron[3 * i + 1], tetrahedron[3 * i + 2]);
        using (BuoyancyMesh mesh = new BuoyancyMesh(vertices, faces))
        {
            Expect(!mesh.WasFlipped, "the winding of converted triangles");
            Poses poses = new Poses(1);
            Wrenches wrenches = new Wrenches(1);
            UnityCoordinates.SetVector(poses.Positions, 0, 0.0, -5.0, 0.0);
            mesh.Query(poses, wrenches);
            UnityCoordinates.GetVector(wrenches.Forces, 0, out x, out y, out z);
            Expect(Math.Abs(y - 1025.0 * 9.80665 / 6.0) < 1e-9 && x == 0.0 && z == 0.0, "buoyancy points up in Unity");
        }
#if UNITY_5_3_OR_NEWER
        UnityEngine.Vector3[] corners = { new UnityEngine.Vector3(1, 2, 3) };
        ExpectEqual(UnityCoordinates.Vertices(corners), new[] { 1.0, 3.0, 2.0 }, "Unity's vertices");
        UnityCoordinates.SetAxialVector(a, 0, corners[0]);
        ExpectEqual(a, new[] { -1.0, -3.0, -2.0 }, "Unity's angular velocities");
        UnityEngine.Vector3 back = UnityCoordinates.AxialVector(a, 0);
        Expect(back.x == 1 && back.y == 2 && back.z == 3, "torques for Unity");
        back = UnityCoordinates.Vector(new[] { 1.0, 3.0, 2.0 }, 0);
        Expect(back.x == 1 && back.y == 2 && back.z == 3, "forces for Unity");
        UnityCoordinates.SetQuaternion(quaternion, 0, new UnityEngine.Quaternion(1, 2, 3, 4));
        Expect(quaternion[0] == 4 && quaternion[1] == -1 && quaternion[2] == -3 && quaternion[3] == -2, "Unity's rotations");
#endif
    }

    private static int Main(string[] arguments)
    {
        Table table = new Table(arguments[0]);
        long cases = table.Longs(1)[0];
        for (long i = 0; i < cases; ++i) Compare(table);
        Expect(cases == 11 && table.IsComplete, "the table is complete");
        TestErrors();
        TestScene();
        TestThreads();
        TestUnityCoordinates();
        Console.WriteLine(cases + " cases are equal to those of C++ bit for bit");
        return 0;
    }
}
