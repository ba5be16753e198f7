// Drops a box of half the density of sea water and prints how it comes to rest:
//
//     mcs client/examples/csharp/FloatingBox.cs client/examples/csharp/Buoyancy.cs -out:FloatingBox.exe
//     mono FloatingBox.exe
//
// The loop is what a game engine does in its fixed time step: pose in, force out, move the body.
using System;
using System.Globalization;
using Buoyancy;

internal static class FloatingBox
{
    private static int Main()
    {
        // A cube of 1 m about the origin.
        double[] vertices = new double[24];
        for (int i = 0; i < 24; ++i) vertices[i] = ((i / 3 >> i % 3) & 1) - 0.5;
        int[] faces = { 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5 };
        const double density = 1025.0 / 2.0, step = 0.01, damping = 800.0;
        try
        {
            using (BuoyancyMesh mesh = new BuoyancyMesh(vertices, faces))
            {
                double mass = density * mesh.Volume, height = 1.0, velocity = 0.0;
                Poses poses = new Poses(1);
                Wrenches wrenches = new Wrenches(1);
                for (int i = 0; i <= 1000; ++i)
                {
                    poses.Positions[2] = height;
                    mesh.Query(poses, wrenches);
                    if (i % 100 == 0)
                        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "{0,5:F1} s  height {1,7:F4} m  force {2,8:F1} N",
                                                        i * step, height, wrenches.Forces[2]));
                    double force = wrenches.Forces[2] - mass * 9.80665 - damping * velocity;
                    velocity += step * force / mass;
                    height += step * velocity;
                }
                Console.WriteLine("buoyancy " + BuoyancyLibrary.Version + ": the box floats with half of it under water");
                return Math.Abs(height) < 1e-3 ? 0 : 1;
            }
        }
        catch (BuoyancyException exception)
        {
            Console.Error.WriteLine(exception.Message);
            return 1;
        }
    }
}
